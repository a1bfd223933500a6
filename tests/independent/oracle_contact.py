"""Coulomb contact for the independent oracle: impacts at a step's end, resting contact inside the forces.

Shapes as in oracle.py. Terrains act in file order, each on what the one before left.
"""

import itertools
from dataclasses import dataclass

import numpy as np


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def with_impulse(v, n, target, friction):
    """Velocities whose normal part the ground brings to `target`; friction takes at most `friction` times that impulse."""
    u = dot(v, n)
    slip = v - u[:, None] * n
    speed = np.sqrt(dot(slip, slip))
    share = np.maximum(0.0, 1.0 - friction * (target - u) / np.where(speed == 0, 1.0, speed))
    share = np.where(speed == 0, 1.0, share)
    return share[:, None] * slip + target[:, None] * n


@dataclass
class Start:
    """How the particles stand to one terrain when a step begins."""

    d: np.ndarray
    n: np.ndarray
    u: np.ndarray
    resting: np.ndarray  # near and slow: the ground answers within the forces
    near: np.ndarray
    fast: np.ndarray  # arrives: bounces
    least: np.ndarray  # normal speed a resting particle may end with at least: down to the surface, gently
    reach: np.ndarray  # the same without "gently", for implicit-euler


class CoulombStep:
    """The ground during one step; all it decides by is the state at the step's start."""

    def __init__(self, world):
        self.world, self.x0, self.v0 = world, world.x, world.v
        self.fall = fall = np.linalg.norm(world.gravity) * world.h  # |g|h
        threshold = max(world.resting_speed, 2 * fall)
        self.starts = []
        for terrain in world.terrains:
            d, n = terrain.distance_and_normal(self.x0)
            u = dot(self.v0, n)
            reach = np.maximum(d, 0.0) / world.h
            self.starts.append(Start(
                d, n, u, resting=world.free & (d < world.distance) & (np.abs(u) <= threshold),
                near=world.free & (d < world.distance), fast=world.free & (u < -threshold), least=-np.minimum(reach, fall), reach=-reach))

    def reaction(self, f):
        """Forces with the ground's answer to particles at rest: over the complete step they end with no approach."""
        world = self.world
        per_step = np.where(world.free, world.h * world.w, 1.0)[:, None]  # h w; pinned particles never rest
        for terrain, start in zip(world.terrains, self.starts):
            ahead = self.v0 + per_step * f
            held = with_impulse(ahead, start.n, start.least, terrain.friction)
            acts = start.resting & (dot(ahead, start.n) < start.least)
            f = np.where(acts[:, None], (held - self.v0) / per_step, f)
        return f

    def bounce(self, terrain, start, mean, change, crossing):
        """Speed after an impact of fast particles. `mean` is the normal speed that the particle moved with during the
        step, `change` what forces added to it, `crossing` the share of the step gone when it met the surface."""
        met = np.minimum(mean + (crossing - 0.5) * change, 0.0)
        lag = start.u + 0.5 * change - mean  # of the position behind the velocity, or ahead of it
        back = terrain.bounce_speed(np.minimum(start.u, 0.0), self.world.m)
        most = np.where(back > 0, back + 2 * self.fall, self.fall)
        return np.clip(terrain.bounce_speed(met, self.world.m) + lag, 0.0, most)

    def crossing(self, d0, d1):
        falls = d0 > d1
        return np.where(falls, np.clip(d0 / np.where(falls, d0 - d1, 1.0), 0.0, 1.0), 0.0)

    def respond(self, x, v, held=None):
        """The end of the step. `held`, with implicit-euler: by terrain, those whom the ground in the equation held."""
        world = self.world
        for index, (terrain, start) in enumerate(zip(world.terrains, self.starts)):
            d, n = terrain.distance_and_normal(x)
            u = dot(v, n)
            set_down = start.near & ~start.fast
            if held is None:
                acts = world.free & (d < world.distance) & (u < start.least) & ((d < 0) | set_down)
                mean, change = (d - start.d) / world.h, u - start.u
                crossing = self.crossing(start.d, d)
            else:
                acts = held[index] & start.fast
                change = world.h * (n @ world.gravity)
                mean = start.u + change
                crossing = self.crossing(start.d, start.d + world.h * mean)
            target = np.where(start.fast, self.bounce(terrain, start, mean, change, crossing),
                              np.where(set_down, start.least, 0.0))
            v = np.where(acts[:, None], with_impulse(v, n, target, terrain.friction), v)
            if held is None:  # what rests rises no faster than it moves, wherever the method's own lag puts it
                speed = np.maximum(np.where(acts, target, u), 0.0)
                undue = np.maximum((d - start.d) - world.h * speed, 0.0)
                rising = start.resting & (d < world.distance) & (undue > 0)
                x = np.where(rising[:, None], x - undue[:, None] * n, x)
                d, n = terrain.distance_and_normal(x)
            x = np.where((world.free & (d < 0))[:, None], x - d[:, None] * n, x)
        return x, v

    def project(self, free):
        """implicit-euler's end velocity from the one that forces alone would give: also its derivative, a 3 x 3 block
        per particle, and by terrain the particles it holds.

        A terrain that would be crossed joins the fewest of those that hold a particle already with which none of them
        is crossed; a second round checks whether a later one moved it through an earlier one. Of surfaces in one place
        the one with more friction holds, of equal ones the first in the file."""
        v, slope = free.copy(), np.tile(np.eye(3), (len(free), 1, 1))
        held = np.zeros((len(self.starts), len(free)), dtype=bool)
        crossed = np.array([dot(free, start.n) < start.reach for start in self.starts]).reshape(held.shape)
        for i in np.flatnonzero(crossed.any(axis=0) & self.world.free):
            by = ()
            for _ in range(2):
                for terrain in range(len(self.starts)):
                    if terrain in by:
                        continue
                    same = [other for other in by if self.in_one_place(i, terrain, other)]
                    joins = (self.rank(terrain) > self.rank(same[0]) if same else self.crosses(i, terrain, v[i]))
                    if joins:
                        others = tuple(other for other in by if other not in same)
                        by, v[i], slope[i] = self.joined(i, others, terrain, free[i]) or (by, v[i], slope[i])
            held[list(by), i] = True
        return v, slope, held

    def crosses(self, i, terrain, v):
        return v @ self.starts[terrain].n[i] < self.starts[terrain].reach[i]

    def in_one_place(self, i, a, b):
        """Whether terrains a and b face the same way and are no further apart than distance/1024 at the step's end."""
        n_a, n_b = self.starts[a].n[i], self.starts[b].n[i]
        apart = self.world.h * abs(self.starts[a].reach[i] - self.starts[b].reach[i])
        parallel = n_a @ n_b > 0 and np.sum(np.cross(n_a, n_b) ** 2) <= 1e-6
        return parallel and apart <= self.world.distance / 1024

    def rank(self, terrain):
        return self.world.terrains[terrain].friction, -terrain

    def joined(self, i, by, terrain, free):
        for count in range(min(len(by), 2) + 1):
            for companions in itertools.combinations(by, count):
                end = self.on_surfaces(i, (*companions, terrain), free)
                if end and not any(self.crosses(i, other, end[0]) for other in by if other not in companions):
                    return (*companions, terrain), *end
        return None

    def on_surfaces(self, i, by, v):
        """The velocity with the normal speeds that bring particle i to the surfaces `by`, and its derivative. Friction
        of the sum of mu times the impulses takes from what motion they leave."""
        N = np.array([self.starts[t].n[i] for t in by])
        gram = N @ N.T
        if np.linalg.det(gram) <= 1e-6:
            return None  # two surfaces that are one
        target = np.array([self.starts[t].reach[i] for t in by])
        impulse_per_speed = -np.linalg.solve(gram, N)
        impulse = np.linalg.solve(gram, target) + impulse_per_speed @ v
        friction = np.where(impulse > 0, [self.world.terrains[t].friction for t in by], 0.0)
        tangential = np.eye(3) + N.T @ impulse_per_speed
        arrived = N.T @ np.linalg.solve(gram, target)
        slip = tangential @ v
        speed = np.linalg.norm(slip)
        loss = friction @ impulse
        if len(by) == 3 or speed == 0 or loss >= speed:
            return arrived, np.zeros((3, 3))
        along = slip / speed
        keep = 1 - loss / speed
        turning = keep * (tangential - np.outer(along, along))
        return arrived + keep * slip, turning + np.outer(along, along) - np.outer(along, friction @ impulse_per_speed)
