"""Reads a scene file for the independent oracle: every default, and cubes made of particles and springs."""

import itertools
import tomllib
from dataclasses import dataclass

import numpy as np

YOUNGS_MODULUS_PER_STIFFNESS = 7.3125  # s * E / k of the infinite lattice

SPRING = {"stiffness": 2000.0, "damping": 60.0}
SIMULATION = {
    "integrator": "explicit-euler", "timestep": 0.001, "duration": 4.0, "gravity": [0.0, -9.8, 0.0], "drag": 0.0,
    "steps-per-frame": 8, "implicit": {"newton-iterations": 20, "cg-iterations": 200, "tolerance": None},
}
CONTACT = {
    "model": "coulomb", "distance": 0.01, "resting-speed": 0.01, "restitution": 0.8, "friction": 0.3,
    "ball-restitution": 1.0, "ball-friction": 0.3, "spin": True, "bodies": False, "self": False, "body-friction": 0.3,
    "body-gap": 0.1, "body-damping": 0.2,
}
TERRAIN = {
    "plane": {"point": [0.0, -1.0, 0.0], "normal": [0.0, 1.0, 0.0]},
    "tilted-plane": {"point": [0.0, 0.0, 0.0], "normal": [1.0, 1.0, 0.0]},
    "sphere": {"center": [0.0, -1.0, 0.0], "radius": 3.0},
    "bowl": {"center": [2.0, 7.0, 1.0], "radius": 7.0},
}
CUBE = {
    "particles-per-edge": 10, "particles": None, "edge-length": 4.0, "position": [0.0, 9.0, 0.0],
    "rotation": {"axis": [1.0, 0.0, 1.0], "angle": 0.0}, "velocity": [0.0, 0.0, 0.0], "pinned": [],
    "friction": None,
}
CUBE_BY_SPRING = {"particle-mass": 1.0, "structural": SPRING, "shear": SPRING, "bending": SPRING}
CUBE_BY_MATERIAL = {"material": {"density": 16.0, "youngs-modulus": 33000.0, "damping-ratio": 0.95}}

BALL = {"radius": 0.3, "mass": 1.0, "position": [7.0, 2.6, 2.0], "velocity": [-49.0, -14.0, -7.0], "angular-velocity": [0.0, 0.0, 0.0]}

# Face name -> (axis, whether it is the far end). A corner is three face names joined by hyphens, any order.
FACES = {
    "left": (0, False), "right": (0, True), "bottom": (1, False), "top": (1, True),
    "back": (2, False), "front": (2, True),
}


class SceneError(Exception):
    """The scene asks for something that is not allowed, or that this program leaves out."""


@dataclass
class Readings:
    """Where the description can be read in two ways; the defaults are the project's."""

    pinned_velocity: str = "zero"  # or "cube": pinned particles drift with the cube's initial velocity
    front: str = "+z"  # the cube's face called "front"; or "-z"


def normalized(vector, where):
    vector = np.asarray(vector, dtype=float)
    length = np.linalg.norm(vector)
    if not length > 0:
        raise SceneError(f"{where} has no direction: its length is zero.")
    return vector / length


def filled(table, defaults, where):
    """`table` with every absent key taken from `defaults`, which also lists the keys that are allowed."""
    for key in table:
        if key not in defaults:
            raise SceneError(f"{where}.{key} is not allowed here; known are {', '.join(defaults)}.")
    return {
        key: filled(table.get(key, {}), default, f"{where}.{key}") if isinstance(default, dict)
        else table.get(key, default)
        for key, default in defaults.items()
    }


def read_scene(path):
    """The scene with every default filled in, except those of a terrain, which depend on its shape."""
    with open(path, "rb") as file:
        scene = tomllib.load(file)
    for kind in ("goal-net", "launcher"):
        if scene.pop(kind, None):
            raise SceneError(f"[[{kind}]] is not covered here: cubes, cells and balls only.")
    known = {"schema": None, "name": "", "author": "", "simulation": SIMULATION, "contact": CONTACT, "terrain": [],
             "cube": [], "ball": [], "material": [], "voxels": [], "actuator": [], "view": None}
    scene = filled(scene, known, "scene")
    if scene["schema"] != 1:
        raise SceneError(f"schema is {scene['schema']}; it must be 1.")
    if not scene["cube"] and not scene["voxels"]:
        raise SceneError("The scene is empty: it has neither [[cube]] nor [[voxels]].")
    if scene["voxels"] and (scene["contact"]["bodies"] or scene["contact"]["self"]):
        raise SceneError("Contact between bodies of cells is not covered here.")
    return scene


def spring_offsets():
    """Half of the neighbor offsets by type: each unordered pair of particles is met once."""
    half = [o for o in itertools.product((-1, 0, 1), repeat=3) if o > (0, 0, 0)]
    axis = [o for o in half if np.abs(o).sum() == 1]
    diagonal = [o for o in half if np.abs(o).sum() > 1]
    return {"structural": axis, "shear": diagonal, "bending": [tuple(2 * c for c in o) for o in axis]}


def pinned_mask(names, n, grid, readings, where):
    """Particles named by faces, by corners such as "top-left-front", or by local index."""
    count = len(grid)
    mask = np.zeros(count, dtype=bool)
    for name in names:
        if isinstance(name, int):
            if not 0 <= name < count:
                raise SceneError(f"{where}.pinned names particle {name}; the indices are 0 to {count - 1}.")
            mask[name] = True
            continue
        parts = name.split("-")
        axes = {FACES[part][0] for part in parts if part in FACES}
        if len(parts) not in (1, 3) or len(axes) != len(parts):
            raise SceneError(f"{where}.pinned names '{name}', which is neither a face nor a corner.")
        chosen = np.ones(count, dtype=bool)
        for axis, far in (FACES[part] for part in parts):
            if axis == 2 and readings.front == "-z":
                far = not far
            chosen &= grid[:, axis] == (n[axis] - 1 if far else 0)
        mask |= chosen
    return mask


def rotation_matrix(axis, degrees, where):
    """Rodrigues' formula, right-handed."""
    if degrees == 0:
        return np.eye(3)
    a = normalized(axis, where)
    cross = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


def build_cube(table, readings, where):
    """Returns m, free, x, v per particle and a, b, r, k, c per spring, with local indices."""
    by = CUBE_BY_MATERIAL if "material" in table else CUBE_BY_SPRING
    cube = filled(table, CUBE | by, where)
    if "particles" in table and "particles-per-edge" in table:
        raise SceneError(f"{where} has both particles and particles-per-edge.")
    n = np.array(cube["particles"] or [cube["particles-per-edge"]] * 3)  # along x, y, z
    if n.min() < 2:
        raise SceneError(f"{where} has {n.tolist()} particles along its edges; at least 2 are needed.")
    s = float(cube["edge-length"]) / (n.max() - 1)
    if "material" in cube:
        material = cube["material"]
        mass = material["density"] * np.prod(s * (n - 1)) / np.prod(n)
        k = material["youngs-modulus"] * s / YOUNGS_MODULUS_PER_STIFFNESS
        c = 2 * material["damping-ratio"] * np.sqrt(k * mass / 2)
        cube |= {kind: {"stiffness": k, "damping": c} for kind in spring_offsets()}
    else:
        mass = float(cube["particle-mass"])

    grid = np.array(list(itertools.product(*map(range, n))))  # row (i*n1 + j)*n2 + k holds (i, j, k)
    matrix = rotation_matrix(cube["rotation"]["axis"], cube["rotation"]["angle"], f"{where}.rotation.axis")
    x = np.array(cube["position"], dtype=float) + (s * (grid - (n - 1) / 2)) @ matrix.T
    pinned = pinned_mask(cube["pinned"], n, grid, readings, where)
    v = np.tile(np.array(cube["velocity"], dtype=float), (len(grid), 1))
    if readings.pinned_velocity == "zero":
        v[pinned] = 0.0

    springs = []
    for kind, offsets in spring_offsets().items():
        for offset in offsets:
            other = grid + offset
            a = np.flatnonzero(np.all((other >= 0) & (other < n), axis=1))
            b = other[a] @ [n[1] * n[2], n[2], 1]
            constants = s * np.linalg.norm(offset), cube[kind]["stiffness"], cube[kind]["damping"]
            springs.append([a, b, *(np.full(len(a), value, dtype=float) for value in constants)])
    return (np.full(len(grid), mass), ~pinned, x, v), [np.concatenate(column) for column in zip(*springs)]


def surface_facts(table):
    """What contact between cubes needs of one whose table build_cube() has taken: n, s, k of structural springs, m, mu if it has its own."""
    cube = filled(table, CUBE | (CUBE_BY_MATERIAL if "material" in table else CUBE_BY_SPRING), "cube")
    (m, *_), (_, _, r, k, _) = build_cube(table, Readings(), "cube")
    n = np.array(cube["particles"] or [cube["particles-per-edge"]] * 3)
    return {"n": n, "s": r.min(), "k": k[r.argmin()], "m": m[0], "mu": cube["friction"]}
