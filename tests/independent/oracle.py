#!/usr/bin/python3
"""An independent double-precision reading of Aspic's physics, for cubes and bodies of cells on terrain, actuators, and balls.

Written from the description in docs/ alone and sharing no code with the product, so that a misreading there
cannot hide behind the same misreading here. Sums are taken in any order: compare within a tolerance.
Shapes: x, v and f are (particles, 3); d, u and m are (particles,). Units are SI.
"""

import argparse
import csv
import sys
import tomllib

import numpy as np

from oracle_balls import Balls
from oracle_cells import MATERIAL, Actuation, build_voxels, cells_of_cube
from oracle_contact import CoulombStep, dot
from oracle_implicit import backward_euler
from oracle_scene import BALL, TERRAIN, Readings, SceneError, build_cube, filled, normalized, read_scene, surface_facts
from oracle_body_contact import Surface, BodyContact

COLUMNS = ["kind", "index", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"]
SPEED_LIMIT = 1000.0  # m/s; faster is divergence


class Diverged(Exception):
    """A step left a number that is not finite, or a speed beyond the limit."""


class Terrain:
    """One immovable surface: d(x) positive on the free side, n(x) towards the free side."""

    def __init__(self, table, contact, where):
        shape = table.get("shape", "plane")
        if shape not in TERRAIN:
            raise SceneError(f"{where}.shape is '{shape}'; known are {', '.join(TERRAIN)}.")
        common = {"shape": shape, "mass": np.inf, "restitution": contact["restitution"],
                  "friction": contact["friction"]}
        table = filled(table, common | TERRAIN[shape], where)
        self.shape, self.mass = shape, float(table["mass"])
        self.restitution, self.friction = float(table["restitution"]), float(table["friction"])
        if "normal" in table:
            self.point = np.array(table["point"], dtype=float)
            self.normal = normalized(table["normal"], f"{where}.normal")
        else:
            self.center, self.radius = np.array(table["center"], dtype=float), float(table["radius"])

    def distance_and_normal(self, x):
        if self.shape in ("plane", "tilted-plane"):
            return (x - self.point) @ self.normal, np.broadcast_to(self.normal, x.shape)
        offset = x - self.center
        length = np.linalg.norm(offset, axis=1)
        central = length == 0
        outward = offset / np.where(central, 1.0, length)[:, None]
        sign = 1.0 if self.shape == "sphere" else -1.0
        normal = np.where(central[:, None], [0.0, 1.0, 0.0], sign * outward)
        return sign * (length - self.radius), normal

    def bounce_speed(self, u, m):
        if np.isinf(self.mass):
            return np.maximum(0.0, -self.restitution * u)
        return np.maximum(0.0, (m - self.restitution * self.mass) / (m + self.mass) * u)


class World:
    """The scene's particles, springs and terrains, advanced step by step."""

    def __init__(self, scene, readings):
        simulation, contact = scene["simulation"], scene["contact"]
        known = [*INTEGRATORS, "implicit-euler"]
        if simulation["integrator"] not in known:
            raise SceneError(f"Integrator '{simulation['integrator']}' is none of {', '.join(known)}.")
        if contact["model"] not in ("coulomb", "course"):
            raise SceneError(f"contact.model is '{contact['model']}'; known are coulomb and course.")
        self.integrate = INTEGRATORS.get(simulation["integrator"])  # None: implicit-euler, which is solved
        self.h, self.duration = float(simulation["timestep"]), float(simulation["duration"])
        self.gravity = np.array(simulation["gravity"], dtype=float)
        self.drag = float(simulation["drag"])
        self.model = contact["model"]
        self.distance, self.resting_speed = float(contact["distance"]), float(contact["resting-speed"])
        self.terrains = [Terrain(t, contact, f"terrain[{i}]") for i, t in enumerate(scene["terrain"])]
        self.readings = readings

        bodies = [build_cube(c, readings, f"cube[{i}]") for i, c in enumerate(scene["cube"])]
        cells = []
        if scene["actuator"]:
            for i, table in enumerate(scene["cube"]):
                particles, made = bodies[i]
                springs, found = cells_of_cube(table, made, f"cube[{i}]")
                bodies[i] = particles, springs
                cells.append(found)
        materials = {m["name"]: filled(m, MATERIAL, "material") for m in scene["material"]}
        for i, table in enumerate(scene["voxels"]):
            made, found = build_voxels(table, materials, readings, f"voxels[{i}]")
            bodies.append(made)
            cells.append(found)
        self.m, self.free, self.x, self.v = (np.concatenate(q) for q in zip(*(p for p, _ in bodies)))
        starts = np.cumsum([0] + [len(particles[0]) for particles, _ in bodies])
        self.a, self.b = (np.concatenate([s[end] + start for (_, s), start in zip(bodies, starts)])
                          for end in (0, 1))
        self.r, self.k, self.c = (np.concatenate([s[q] for _, s in bodies]) for q in (2, 3, 4))
        self.r0, self.steps, self.actuation = self.r, 0, None
        if scene["actuator"]:
            first = np.cumsum([0] + [len(springs[0]) for _, springs in bodies])
            self.actuation = Actuation(scene["actuator"], list(zip(first, cells)))
        self.w = np.where(self.free, 1.0 / self.m, 0.0)
        surfaces = [Surface(tuple(made["n"]), made["s"], made["k"], made["m"], start, self.x,
                            contact["body-friction"] if made["mu"] is None else made["mu"])
                    for made, start in zip((surface_facts(c) for c in scene["cube"]), starts)]
        self.body_contact = BodyContact(self, surfaces, contact) if contact["bodies"] or contact["self"] else None
        tables = [filled(b, BALL, f"ball[{i}]") for i, b in enumerate(scene["ball"])]
        self.balls = Balls(self, tables, contact, surfaces) if tables else None

    def spring_force(self, x, v):
        e = x[self.a] - x[self.b]
        length = np.sqrt(dot(e, e))
        divisor = np.where(length == 0, 1.0, length)  # e = 0 then makes the force zero
        approach = dot(v[self.a] - v[self.b], e) / divisor
        scale = -(self.k * (length - self.r) + self.c * approach) / divisor
        f = scale[:, None] * e
        count = len(x)
        return np.stack([np.bincount(self.a, f[:, i], count) - np.bincount(self.b, f[:, i], count)
                         for i in range(3)], axis=1)

    def be_at(self, c):
        """Rest lengths become those of the time t + ch."""
        if self.actuation:
            self.r = self.actuation.lengths(self.r0, self.h * (self.steps + c))

    def own_force(self, v):
        """Gravity and the drag of the medium on particles with these velocities."""
        return self.m[:, None] * (self.gravity - self.drag * v)

    def acceleration(self, c, x, v):
        """At the time t + ch."""
        self.be_at(c)
        f = self.own_force(v) + self.spring_force(x, v)
        if self.body_contact:
            f = self.body_contact.forces(x, v, f)
        f = self.course_contact_force(x, v, f) if self.model == "course" else self.ground.reaction(f)
        return self.w[:, None] * f

    def course_contact_force(self, x, v, f):
        for terrain in self.terrains:
            d, n = terrain.distance_and_normal(x)
            u = dot(v, n)
            v_t = v - u[:, None] * n
            acts = (d < self.distance) & (np.abs(u) < self.resting_speed) & (dot(f, n) < 0)
            normal_force = np.where(acts, -dot(f, n), 0.0)[:, None]
            f = f + normal_force * n - terrain.friction * normal_force * v_t
        return f

    def course_response(self, x, v):
        for terrain in self.terrains:
            d, n = terrain.distance_and_normal(x)
            u = dot(v, n)
            acts = self.free & (d < self.distance) & (u < 0)
            bounced = v + (terrain.bounce_speed(u, self.m) - u)[:, None] * n
            v = np.where(acts[:, None], bounced, v)
        return x, v

    def step(self):
        """Advances by h; on divergence the last good state is kept and Diverged is raised."""
        with np.errstate(over="ignore", invalid="ignore"):
            self.be_at(0)
            self.ground = CoulombStep(self) if self.model == "coulomb" else None
            if self.body_contact:
                self.body_contact.begin(self.x, self.v)
            held = None
            if self.integrate:
                x, v = self.integrate(self.acceleration, self.x, self.v, self.h)
            else:
                x, v, held = backward_euler(self)
            if self.model == "course":
                x, v = self.course_response(x, v)
            else:
                x, v = self.ground.respond(x, v, held)
            if self.balls:
                x, v = self.balls.step(self.v, x, v)
            good = np.all(np.isfinite(x) & np.isfinite(v), axis=1) & (np.sqrt(dot(v, v)) <= SPEED_LIMIT)
        if not good.all():
            raise Diverged(f"particle {np.flatnonzero(~good)[0]} diverged with a time step of {self.h} s")
        self.x, self.v = x, v
        self.steps += 1


# a(c, x, v) is the acceleration at the time t + ch.
def explicit_euler(a, x, v, h):
    return x + h * v, v + h * a(0, x, v)


def symplectic_euler(a, x, v, h):
    v = v + h * a(0, x, v)
    return x + h * v, v


def midpoint(a, x, v, h):
    x_m, v_m = x + h / 2 * v, v + h / 2 * a(0, x, v)
    return x + h * v_m, v + h * a(1 / 2, x_m, v_m)


def runge_kutta_4(a, x, v, h):
    v1, a1 = v, a(0, x, v)
    v2 = v + h / 2 * a1
    a2 = a(1 / 2, x + h / 2 * v1, v2)
    v3 = v + h / 2 * a2
    a3 = a(1 / 2, x + h / 2 * v2, v3)
    v4 = v + h * a3
    a4 = a(1, x + h * v3, v4)
    return x + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)


def heun_3(a, x, v, h):
    a1 = a(0, x, v)
    v2 = v + h / 3 * a1
    a2 = a(1 / 3, x + h / 3 * v, v2)
    v3 = v + 2 * h / 3 * a2
    a3 = a(2 / 3, x + 2 * h / 3 * v2, v3)
    return x + h / 4 * (v + 3 * v3), v + h / 4 * (a1 + 3 * a3)


def velocity_verlet(a, x, v, h):
    a0 = a(0, x, v)
    x1 = x + h * v + h * h / 2 * a0
    return x1, v + h / 2 * (a0 + a(1, x1, v + h * a0))


def implicit_euler_one_pass(a, x, v, h):
    x_p, v_p = x + h * v, v + h * a(0, x, v)
    return x + h * v_p, v + h * a(1, x_p, v_p)


INTEGRATORS = {
    "explicit-euler": explicit_euler, "symplectic-euler": symplectic_euler, "midpoint": midpoint,
    "runge-kutta-4": runge_kutta_4, "implicit-euler-one-pass": implicit_euler_one_pass,
    "heun-3": heun_3, "velocity-verlet": velocity_verlet,
}


def write_state(path, world):
    with open(path, "w", newline="") as file:
        file.write(",".join(COLUMNS) + "\n")
        for index, (x, v) in enumerate(zip(world.x.tolist(), world.v.tolist())):
            file.write(",".join(["particle", str(index), *map(repr, x + v + [0.0] * 3)]) + "\n")
        if world.balls:
            for index, numbers in enumerate(world.balls.numbers().tolist()):
                file.write(",".join(["ball", str(index), *map(repr, numbers)]) + "\n")


def read_state(path):
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    return head, rows


def compare(path_a, path_b, tolerance):
    """Prints the largest absolute difference per column; returns 0 within the tolerance, 1 past it."""
    (head_a, rows_a), (head_b, rows_b) = read_state(path_a), read_state(path_b)
    if head_a != COLUMNS or head_b != COLUMNS:
        print("The header of a state file is not " + ",".join(COLUMNS), file=sys.stderr)
        return 1
    if [row[:2] for row in rows_a] != [row[:2] for row in rows_b] or not rows_a:
        print(f"The rows do not match: {len(rows_a)} against {len(rows_b)}.", file=sys.stderr)
        return 1
    a, b = (np.array([row[2:] for row in rows], dtype=float) for rows in (rows_a, rows_b))
    difference = np.abs(a - b)
    difference[~np.isfinite(difference)] = np.inf
    for name, column in zip(COLUMNS[2:], difference.T):
        kind, index = rows_a[column.argmax()][:2]
        print(f"{name:3} {column.max():.3e}  at {kind} {index}")
    return int(difference.max() > tolerance)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", nargs="?", metavar="SCENE.toml")
    parser.add_argument("--steps", type=int, help="default: the scene's duration")
    parser.add_argument("--state", metavar="OUT.csv", help="write the final state")
    parser.add_argument("--pinned-velocity", choices=["zero", "cube"], default=Readings.pinned_velocity)
    parser.add_argument("--front", choices=["+z", "-z"], default=Readings.front)
    parser.add_argument("--compare", nargs=2, metavar=("A.csv", "B.csv"))
    parser.add_argument("--tolerance", type=float, default=1e-9)
    options = parser.parse_args()
    if options.compare:
        return compare(*options.compare, options.tolerance)
    if not options.scene or not options.state:
        parser.error("either SCENE.toml with --state, or --compare, is needed")
    try:
        readings = Readings(options.pinned_velocity, options.front)
        world = World(read_scene(options.scene), readings)
    except (SceneError, tomllib.TOMLDecodeError) as error:
        print(f"{options.scene}: {error}", file=sys.stderr)
        return 3
    steps = round(world.duration / world.h) if options.steps is None else options.steps
    status = 0
    for step in range(1, steps + 1):
        try:
            world.step()
        except Diverged as error:
            print(f"Step {step}: {error}; the state kept is that of step {step - 1}.", file=sys.stderr)
            status = 5
            break
    write_state(options.state, world)
    return status


if __name__ == "__main__":
    sys.exit(main())
