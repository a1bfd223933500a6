"""Contact between cubes, written from docs/contact.md alone: of every point all candidates are looked at in every evaluation.

Arrays are (particles, 3), (points, 3) and (triangles, 3); one pair of bodies at a time.
"""

import numpy as np

YOUNGS_MODULUS_PER_STIFFNESS = 7.3125
REST_DISTANCE = 2.1  # within one body, in spacings
DEPTH = 0.25  # up to where normal forces act inside, in spacings
AHEAD = 0.4  # from where implicit Euler knows of contacts, in spacings


def dot(a, b):
    return (a * b).sum(-1)


class Surface:
    """Points and triangles of a cube of n particles along its edges, the first of which is `first`."""

    def __init__(self, n, spacing, stiffness, mass, first, x, mu):
        self.mu = float(mu)
        self.spacing, self.kappa, self.mass = spacing, YOUNGS_MODULUS_PER_STIFFNESS * stiffness, mass
        at = np.arange(np.prod(n)).reshape(n) + first
        triangles, sides, edges = [], [], {}
        for axis in range(3):
            for high in (0, 1):
                layer = np.moveaxis(np.take(at, -high, axis), (0, 1), (0, 1) if axis != 1 else (1, 0))
                for i in range(layer.shape[0] - 1):      # along the next axis, then the one after
                    for j in range(layer.shape[1] - 1):
                        q = [layer[i, j], layer[i + 1, j], layer[i + 1, j + 1], layer[i, j + 1]]
                        q = q if high else [q[0], q[3], q[2], q[1]]
                        triangles += [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
                        sides += [2 * axis + high] * 2
                        for a, b in zip(q, q[1:] + q[:1]):
                            edges.setdefault((min(a, b), max(a, b)), set()).add(2 * axis + high)
        self.triangles, self.sides = np.array(triangles), np.array(sides)
        particles = np.unique(self.triangles)
        sharp = np.array(sorted(e for e, at_sides in edges.items() if len(at_sides) > 1))
        carriers, weights = [particles[:, None].repeat(2, 1)], [np.tile([1.0, 0.0], (len(particles), 1))]
        for edge in sharp:
            carriers.append(np.tile(edge, (2, 1)))
            weights.append(np.array([[2 / 3, 1 / 3], [1 / 3, 2 / 3]]))
        self.carriers, self.weights = np.concatenate(carriers), np.concatenate(weights)
        rest = self.points(x)
        corner_distance = np.linalg.norm(rest[:, None, None] - x[self.triangles][None], axis=-1).min(-1)
        self.far_at_rest = corner_distance > REST_DISTANCE * spacing

    def points(self, values):
        return (values[self.carriers] * self.weights[..., None]).sum(1)


def nearest(p, a, b, c):
    """Weights of corners b and c at the place of each triangle nearest to each point, and whether it is in the face."""
    ab, ac = b - a, c - a
    d1, d2 = dot(ab, p - a), dot(ac, p - a)
    d3, d4 = dot(ab, p - b), dot(ac, p - b)
    d5, d6 = dot(ab, p - c), dot(ac, p - c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        regions = [
            ((d1 <= 0) & (d2 <= 0), 0, 0), ((d3 >= 0) & (d4 <= d3), 1, 0),
            ((vc <= 0) & (d1 >= 0) & (d3 <= 0), d1 / (d1 - d3), 0), ((d6 >= 0) & (d5 <= d6), 0, 1),
            ((vb <= 0) & (d2 >= 0) & (d6 <= 0), 0, d2 / (d2 - d6)), ((va <= 0) & (d4 >= d3) & (d5 >= d6), 1 - t, t),
        ]
        wb = np.select([r[0] for r in regions], [np.broadcast_to(r[1], d1.shape) for r in regions], vb / (va + vb + vc))
        wc = np.select([r[0] for r in regions], [np.broadcast_to(r[2], d1.shape) for r in regions], vc / (va + vb + vc))
    return wb, wc, ~np.logical_or.reduce([r[0] for r in regions])


class BodyContact:
    """Contact of a step: made for a world once, told of each step's start."""

    def __init__(self, world, surfaces, contact):
        self.world, self.surfaces = world, surfaces
        self.gap, self.zeta = float(contact["body-gap"]), float(contact["body-damping"])
        self.pairs = [(a, b) for a in range(len(surfaces)) for b in range(len(surfaces))
                      if (contact["self"] if a == b else contact["bodies"])]
        self.eased, self.steps, self.acted, self.initial = {}, 0, False, True
        self.begin(world.x, world.v)  # overlaps in the initial state
        self.steps = 0
        for pair, point, d in zip(*(self.contacts(world.x, world.v)[key] for key in ("pair", "point", "d"))):
            self.eased[pair, point] = min(d, self.eased.get((pair, point), np.inf))
        self.steps, self.initial = -1, False

    def constants(self, a, b):
        A, B = self.surfaces[a], self.surfaces[b]
        s = min(A.spacing, B.spacing)
        k = 2 * A.kappa * B.kappa / (A.kappa + B.kappa)
        return k, 2 * self.zeta * np.sqrt(k / (1 / A.mass + 1 / B.mass)), s, self.gap * s, (0.5 if a == b else 1.0) * s  # D of bodies that are eased apart

    def begin(self, x, v):
        self.v0, self.steps = v, self.steps + 1
        self.candidates = {}
        for a, b in self.pairs:
            *_, s, reach, depth = self.constants(a, b)
            P, corners = self.surfaces[a].points(x)[:, None], x[self.surfaces[b].triangles]
            margin = max(depth, reach) + 0.5 * s
            holds = ((P >= corners.min(1) - margin) & (P <= corners.max(1) + margin)).all(-1)
            self.candidates[a, b] = holds & self.surfaces[a].far_at_rest if a == b else holds

    def contacts(self, x, v, solve=0):
        """Of the explicit methods, or of implicit Euler's first or second solve."""
        found = {key: [] for key in ("pair", "point", "index", "weight", "n", "d", "reach", "normal_force", "rest", "c", "mu")}
        for pair in self.pairs:
            for contact in self.of_pair(*pair, x, v, solve):
                for key, value in contact.items():
                    found[key].append(value)
        return found

    def normals(self, surface, x):
        corners = x[surface.triangles]
        g = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        sums = np.zeros_like(x)
        for corner in range(3):
            np.add.at(sums, surface.triangles[:, corner], g)
        return surface.points(sums)

    def of_pair(self, a, b, x, v, solve):
        k, c, s, reach, depth = self.constants(a, b)
        sight = max(reach, AHEAD * s) if solve else reach
        c = k * self.world.h if solve else c
        A, B = self.surfaces[a], self.surfaces[b]
        if not self.candidates[a, b].any():
            return
        P, corners = A.points(x), x[B.triangles]
        ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        g = np.cross(ab, ac)
        # From here on one number for each point and each of its triangles, points ascending.
        points, t = np.nonzero(self.candidates[a, b] & (self.normals(A, x) @ g.T < 0))
        wb, wc, face = nearest(P[points], *(corners[t, i] for i in range(3)))
        e = P[points] - corners[t, 0] - wb[:, None] * ab[t] - wc[:, None] * ac[t]
        N = g[t] / np.linalg.norm(g[t], axis=-1, keepdims=True)
        L, z, sides = np.linalg.norm(e, axis=-1), dot(e, N), B.sides[t].tolist()
        straight = np.where(face, 1.0, np.abs(z) / np.where(L > 0, L, 1)).tolist()
        far, high = L.tolist(), z.tolist()  # single numbers of lists are read faster

        def pick(among):
            least = min(far[q] for q in among)
            return min((q for q in among if far[q] <= least + 2e-6 * s), key=lambda q: (-straight[q], far[q]))

        ends = [*np.flatnonzero(np.diff(points, prepend=-1)).tolist(), len(points)]
        for begin, end in zip(ends, ends[1:]):
            point, seen = int(points[begin]), range(begin, end)
            if min(far[begin:end]) > depth:
                continue
            first = pick(seen)
            chosen = []
            start = self.eased.get(((a, b), point), np.inf)
            back = start + s * self.steps * self.world.h
            deepest = depth if self.initial or back < reach else DEPTH * s
            if (far[first] < sight if high[first] >= 0 else far[first] <= deepest and -high[first] >= 0.7 * far[first]):
                chosen.append(first)
            for side in sorted(set(sides[begin:end]) - {sides[first]}):
                q = pick([q for q in seen if sides[q] == side])
                if 0 <= high[q] and far[q] < sight and high[q] >= 0.9 * far[q]:
                    chosen.append(q)
            for q in chosen:
                d = np.copysign(L[q], 1 if z[q] >= 0 else -1)
                n = N[q] if face[q] or d == 0 else e[q] / d
                d = z[q] if face[q] else d
                index = np.concatenate([A.carriers[point], B.triangles[t[q]]])
                weight = np.concatenate([A.weights[point], -np.array([1 - wb[q] - wc[q], wb[q], wc[q]])])
                reached = min(reach, back)
                u = n @ (weight @ v[index])
                rest = k * (reached - d) + (c * u if solve == 2 else 0.0)
                yield {"pair": (a, b), "point": point, "index": index, "weight": weight, "n": n, "d": d, "reach": reached,
                       "normal_force": max(0.0, rest - c * u), "rest": rest, "c": c, "mu": min(A.mu, B.mu)}

    def forces(self, x, v, f):
        """The forces f with normal forces and friction."""
        found = self.contacts(x, v)
        if not found["normal_force"]:
            return f
        f, friction = self.with_friction({key: np.array(found[key]) for key in ("index", "weight", "n", "normal_force", "mu")}, f)
        np.add.at(f, found["index"], np.array(found["weight"])[..., None] * friction[:, None])
        return f

    def with_friction(self, found, f):
        """The forces f with normal forces, and the friction of each contact, which is not in them."""
        index, weight, n, normal_force = (found[key] for key in ("index", "weight", "n", "normal_force"))
        f, h, w = f.copy(), self.world.h, self.world.w
        np.add.at(f, index, weight[..., None] * (normal_force[:, None] * n)[:, None])
        v1 = self.v0 + h * w[:, None] * f
        share = np.zeros(len(f))
        np.add.at(share, index, np.abs(weight) * normal_force[:, None])
        on = normal_force > 0
        W = np.where(on, (np.abs(weight) * w[index] * share[index]).sum(1) / np.where(on, normal_force, 1), 0)
        r = (weight[..., None] * v1[index]).sum(1)
        slip = r - dot(r, n)[:, None] * n
        J = slip / np.where(W > 0, W, np.inf)[:, None]
        size, cone = np.linalg.norm(J, axis=1), found["mu"] * h * normal_force
        J *= np.where(size > cone, cone / np.where(size > 0, size, 1), 1)[:, None]
        self.acted = True
        return f, -J / h

    def ahead(self, x, v, f, solve):
        """The contacts of a solve of implicit Euler; f: gravity and springs where the step begins. None: there are none."""
        found = {key: np.array(value) for key, value in self.contacts(x, v, solve).items() if key not in ("pair", "point")}
        if not len(found["normal_force"]):
            return None
        return found | {"friction": self.with_friction(found, f)[1], "cone": found["mu"] * found["normal_force"]}

    def react(self, held, v):
        """Forces of these contacts at the velocities v of the step's end, and -h times their derivative by these, as an
        array (particles, 3, particles, 3)."""
        index, weight, n, c, cone = (held[key] for key in ("index", "weight", "n", "c", "cone"))
        h = self.world.h
        r = (weight[..., None] * v[index]).sum(1)
        u = dot(r, n)
        normal_force = np.maximum(0.0, held["rest"] - c * u)
        p = held["friction"] - c[:, None] * (r - u[:, None] * n)
        size = np.linalg.norm(p, axis=1)
        share = np.where(size > cone, cone / np.where(size > 0, size, 1), 1.0) * (cone > 0)
        t = np.where((size > cone)[:, None], p / np.where(size > 0, size, 1)[:, None], 0.0)
        f = np.zeros_like(v)
        np.add.at(f, index, weight[..., None] * (normal_force[:, None] * n + share[:, None] * p)[:, None])
        nn, tt = n[:, :, None] * n[:, None], t[:, :, None] * t[:, None]
        block = (h * c)[:, None, None] * ((normal_force > 0)[:, None, None] * nn + share[:, None, None] * (np.eye(3) - nn - tt))
        matrix = np.zeros((len(v), 3, len(v), 3))
        for i in range(5):
            for j in range(5):
                both = (weight[:, i] * weight[:, j])[:, None, None] * block
                np.add.at(matrix, (index[:, i], slice(None), index[:, j]), both)
        return f, matrix
