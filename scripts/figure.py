#!/usr/bin/env python3
"""figure.py > assets/meshes/rabbit.obj: makes the built-in mesh, a sitting rabbit of smoothly joined ellipsoids.

The surface is where a field of distances is 0. Surface nets (Gibson, 1998) find it on a grid, and each vertex is then moved onto it. Quads
turn counterclockwise seen from outside. Lengths are meters; y is up and the rabbit looks along z.
"""

import math

STEP = 1 / 12  # of the grid [m]
LOW, COUNTS = (-9 / 12, -1 / 12, -1.0), (19, 29, 23)

# Middle, radii, turn about x [degrees], how softly it joins what is before it [m].
PARTS = [
    ((0.00, 0.50, -0.10), (0.48, 0.50, 0.56), 0, 0.00),  # trunk
    ((0.00, 0.58, 0.22), (0.38, 0.44, 0.34), 0, 0.15),  # breast
    ((0.00, 1.12, 0.32), (0.30, 0.29, 0.33), 0, 0.14),  # head
    ((0.00, 1.05, 0.57), (0.17, 0.14, 0.15), 0, 0.10),  # muzzle
    ((0.15, 1.66, 0.12), (0.145, 0.46, 0.115), -14, 0.07),  # ears
    ((-0.15, 1.66, 0.12), (0.145, 0.46, 0.115), -14, 0.07),
    ((0.38, 0.32, 0.02), (0.22, 0.34, 0.38), 0, 0.09),  # thighs
    ((-0.38, 0.32, 0.02), (0.22, 0.34, 0.38), 0, 0.09),
    ((0.36, 0.10, 0.36), (0.16, 0.11, 0.30), 0, 0.07),  # hind feet
    ((-0.36, 0.10, 0.36), (0.16, 0.11, 0.30), 0, 0.07),
    ((0.15, 0.22, 0.50), (0.12, 0.24, 0.13), 0, 0.07),  # forefeet
    ((-0.15, 0.22, 0.50), (0.12, 0.24, 0.13), 0, 0.07),
    ((0.00, 0.42, -0.68), (0.19, 0.19, 0.18), 0, 0.06),  # tail
]


def ellipsoid(point, middle, radii, turn):
    """About the distance from an ellipsoid, negative inside."""
    x, y, z = (p - m for p, m in zip(point, middle))
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    local = (x, c * y - s * z, s * y + c * z)
    near = math.sqrt(sum((q / r) ** 2 for q, r in zip(local, radii)))
    steep = math.sqrt(sum((q / (r * r)) ** 2 for q, r in zip(local, radii)))
    return near * (near - 1.0) / steep if steep > 0.0 else -min(radii)


def field(point):
    """Negative inside the rabbit."""
    value = None
    for middle, radii, turn, soft in PARTS:
        part = ellipsoid(point, middle, radii, turn)
        if value is None:
            value = part
            continue
        mixed = max(soft - abs(value - part), 0.0) / soft
        value = min(value, part) - mixed * mixed * soft / 4.0
    return value


def slope(point):
    """Gradient of the field."""
    d = 1e-5
    ahead = [field(tuple(p + (d if a == axis else 0.0) for a, p in enumerate(point))) for axis in range(3)]
    back = [field(tuple(p - (d if a == axis else 0.0) for a, p in enumerate(point))) for axis in range(3)]
    return [(f - b) / (2.0 * d) for f, b in zip(ahead, back)]


def onto_surface(point):
    """Moved along the gradient to where the field is 0."""
    for _ in range(4):
        value, gradient = field(point), slope(point)
        size = sum(g * g for g in gradient)
        point = tuple(p - value * g / size for p, g in zip(point, gradient))
    return point


def surface_nets():
    """Vertices, one in each cell that the surface passes through, and the quads around edges that it crosses."""
    def place(i, j, k):
        return tuple(low + STEP * n for low, n in zip(LOW, (i, j, k)))

    points = {(i, j, k): field(place(i, j, k))
              for i in range(COUNTS[0]) for j in range(COUNTS[1]) for k in range(COUNTS[2])}
    number, vertices, quads = {}, [], []
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    edges = [(a, b) for a in corners for b in corners if a < b and sum(p != q for p, q in zip(a, b)) == 1]
    for cell in points:
        if any(n + 1 == count for n, count in zip(cell, COUNTS)):
            continue
        around = {c: tuple(n + o for n, o in zip(cell, c)) for c in corners}
        crossings = []
        for a, b in edges:
            va, vb = points[around[a]], points[around[b]]
            if (va < 0.0) != (vb < 0.0):
                share = va / (va - vb)
                crossings.append([p + share * (q - p) for p, q in zip(place(*around[a]), place(*around[b]))])
        if crossings:
            number[cell] = len(vertices) + 1
            vertices.append(onto_surface(tuple(sum(c[axis] for c in crossings) / len(crossings) for axis in range(3))))
    for point, value in points.items():
        for axis in range(3):
            end = tuple(n + (a == axis) for a, n in enumerate(point))
            if end not in points or (value < 0.0) == (points[end] < 0.0):
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            cells = [tuple(n - (a == u) * du - (a == v) * dv for a, n in enumerate(point))
                     for du, dv in ((1, 1), (0, 1), (0, 0), (1, 0))]
            quad = [number[c] for c in cells]
            quads.append(quad if value < 0.0 else quad[::-1])
    return vertices, quads


def main():
    vertices, quads = surface_nets()
    ground = min(v[1] for v in vertices)
    print("# A sitting rabbit, made by scripts/figure.py. Meters, y is up.")
    for x, y, z in vertices:
        print(f"v {x:.3f} {y - ground:.3f} {z:.3f}".replace("-0.000", "0.000"))
    for quad in quads:
        print("f", *quad)


if __name__ == "__main__":
    main()
