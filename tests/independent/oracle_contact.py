"""Coulomb contact for the independent oracle: impacts at a step's end, resting contact inside the forces.

Shapes as in oracle.py. Terrains act in file order, each on what the one before left.
"""

from dataclasses import dataclass

import numpy as np


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def pushed(v, n, target, friction):
    """Velocities whose normal part the ground brings to `target`, with friction of at most `friction` times that push.

    Returns the new velocities, the slip before, its length, and the share of the slip that friction leaves.
    """
    u = dot(v, n)
    slip = v - u[:, None] * n
    speed = np.sqrt(dot(slip, slip))
    share = np.maximum(0.0, 1.0 - friction * (target - u) / np.where(speed == 0, 1.0, speed))
    share = np.where(speed == 0, 1.0, share)
    return share[:, None] * slip + target[:, None] * n, slip, speed, share


@dataclass
class Start:
    """How the particles stand to one terrain when a step begins."""

    d: np.ndarray
    n: np.ndarray
    u: np.ndarray
    resting: np.ndarray
    fast: np.ndarray
    least: np.ndarray  # normal speed a resting particle may end with at least: down to the surface, gently
    reach: np.ndarray  # the same without "gently", for implicit-euler


class CoulombStep:
    """The ground during one step; all it decides by is the state at the step's start."""

    def __init__(self, world):
        self.world, self.x0, self.v0 = world, world.x, world.v
        fall = np.linalg.norm(world.gravity) * world.h  # |g|h
        self.slack, threshold = 2 * fall, max(world.epsilon, 2 * fall)
        self.starts = []
        for terrain in world.terrains:
            d, n = terrain.distance_and_normal(self.x0)
            u = dot(self.v0, n)
            reach = np.maximum(d, 0.0) / world.h
            self.starts.append(Start(
                d, n, u, resting=world.free & (d < world.epsilon) & (np.abs(u) <= threshold),
                fast=world.free & (u < -threshold), least=-np.minimum(reach, fall), reach=-reach))

    def reaction(self, f):
        """Forces with the ground's answer to particles at rest: over the complete step they end with no approach."""
        world = self.world
        per_step = np.where(world.free, world.h * world.w, 1.0)[:, None]  # h w; pinned particles never rest
        for terrain, start in zip(world.terrains, self.starts):
            ahead = self.v0 + per_step * f
            held = pushed(ahead, start.n, start.least, terrain.friction)[0]
            acts = start.resting & (dot(ahead, start.n) < start.least)
            f = np.where(acts[:, None], (held - self.v0) / per_step, f)
        return f

    def bounce(self, terrain, start, mean, change, crossing):
        """Speed after an impact of fast particles. `mean` is the normal speed that the particle moved with during the
        step, `change` what forces added to it, `crossing` the share of the step gone when it met the surface."""
        met = np.minimum(mean + (crossing - 0.5) * change, 0.0)
        lag = start.u + 0.5 * change - mean  # of the position behind the velocity, or ahead of it
        most = terrain.bounce_speed(np.minimum(start.u, 0.0), self.world.m) + self.slack
        return np.clip(terrain.bounce_speed(met, self.world.m) + lag, 0.0, most)

    def crossing(self, d0, d1):
        falls = d0 > d1
        return np.where(falls, np.clip(d0 / np.where(falls, d0 - d1, 1.0), 0.0, 1.0), 0.0)

    def respond(self, x, v, stopped=None):
        """The end of the step. `stopped`, with implicit-euler: those whom the ground within the equation stopped."""
        world = self.world
        for terrain, start in zip(world.terrains, self.starts):
            d, n = terrain.distance_and_normal(x)
            u = dot(v, n)
            if stopped is None:
                acts = world.free & (d < world.epsilon) & (u < start.least) & ((d < 0) | start.resting)
                mean, change = (d - start.d) / world.h, u - start.u
                crossing = self.crossing(start.d, d)
            else:
                acts = stopped & start.fast & (d < world.epsilon)
                change = world.h * (n @ world.gravity)
                mean = start.u + change
                crossing = self.crossing(start.d, start.d + world.h * mean)
            target = np.where(start.fast, self.bounce(terrain, start, mean, change, crossing),
                              np.where(start.resting, start.least, 0.0))
            v = np.where(acts[:, None], pushed(v, n, target, terrain.friction)[0], v)
            risen = acts & (target == 0) & (d > start.d)
            x = np.where(risen[:, None], x - (d - start.d)[:, None] * n, x)
            d, n = terrain.distance_and_normal(x)
            x = np.where((world.free & (d < 0))[:, None], x - d[:, None] * n, x)
        return x, v

    def project(self, v):
        """implicit-euler's end velocity from the one that forces alone would give: also its derivative, a 3 x 3 block
        per particle, and the particles on which any ground acted."""
        world = self.world
        slope = np.broadcast_to(np.eye(3), (len(v), 3, 3))
        touched = np.zeros(len(v), dtype=bool)
        for terrain, start in zip(world.terrains, self.starts):
            n = start.n
            u = dot(v, n)
            acts = world.free & (u < start.reach)
            held, slip, speed, share = pushed(v, n, start.reach, terrain.friction)
            # v_t - mu (c - u) v_t/|v_t| + c n: the normal part is prescribed, the slip loses mu (c - u) along itself,
            # and that loss turns with the slip. Where nothing of the slip is left, nothing depends on v.
            along = slip / np.where(speed == 0, 1.0, speed)[:, None]
            nn, tt = n[:, :, None] * n[:, None, :], along[:, :, None] * along[:, None, :]
            turning = share[:, None, None] * (np.eye(3) - nn - tt)
            sliding = turning + tt + terrain.friction * along[:, :, None] * n[:, None, :]
            local = np.where(((share > 0) & (speed > 0))[:, None, None], sliding, 0.0)
            slope = np.where(acts[:, None, None], local @ slope, slope)
            v = np.where(acts[:, None], held, v)
            touched |= acts
        return v, slope, touched
