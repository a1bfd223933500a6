"""Balls, written from docs/balls.md alone: flight, and what they do to each other, to particles and to faces.

Terrain is left out: a ball that comes near it is refused. Every ball is compared with every particle and every triangle.
"""

import numpy as np

from oracle_scene import SceneError
from oracle_body_contact import dot, nearest


class Pairs:
    """Pairs of a phase: each a ball, another ball or one or three particles with their shares, and the normal towards the ball."""

    def __init__(self):
        self.rows = []

    def add(self, ball, others, shares, n, gap):
        self.rows.append((ball, others, np.array(shares, dtype=float), n, gap))


class Balls:
    def __init__(self, world, tables, contact, surfaces):
        self.world, self.contact = world, contact
        self.x, self.v, self.omega = (np.array([t[key] for t in tables], dtype=float).reshape(-1, 3)
                                      for key in ("position", "velocity", "angular-velocity"))
        self.R, self.m = (np.array([t[key] for t in tables], dtype=float) for key in ("radius", "mass"))
        self.w, self.I = 1 / self.m, 0.4 * self.m * self.R**2
        self.e, self.mu = contact["ball-restitution"], contact["ball-friction"]
        self.resting = max(self.world.resting_speed, 2 * np.linalg.norm(world.gravity) * world.h)
        self.surfaces = surfaces if contact["bodies"] and contact["model"] == "coulomb" else []
        self.acted = False

    def numbers(self):
        """Of each ball x, v and ω."""
        return np.hstack([self.x, self.v, self.omega])

    def step(self, start_v, x, v):
        """Balls go from one state to the next, in which they change the particles, which began with start_v."""
        w = self.world.w
        self.v0 = self.v.copy()
        fly = self.world.integrate or (lambda a, y, u, h: (y + h * (u + h * a(0, y, u)), u + h * a(0, y, u)))
        self.x, self.v = fly(lambda c, y, u: self.world.gravity - self.world.drag * self.v0, self.x, self.v, self.world.h)
        for terrain in self.world.terrains:
            if np.any(terrain.distance_and_normal(self.x)[0] < self.R + 2 * self.world.distance):
                raise SceneError("A ball is near terrain, which this reading leaves out.")
        near = [(b, p) for b in range(len(self.x)) for p in np.flatnonzero(self.distances(b, x) < self.R[b] + self.world.distance)]
        faces = [face for b in range(len(self.x)) for surface in self.surfaces
                 if (face := self.nearest_face(b, surface, x)) is not None]
        balls = [(a, b) for a in range(len(self.x)) for b in range(a)
                 if np.linalg.norm(self.x[a] - self.x[b]) < self.R[a] + self.R[b] + self.world.distance]
        self.acted |= bool(near or faces or balls)
        if balls:
            raise SceneError("Two balls meet, which this reading leaves out.")

        def particle_pairs(overlapping):
            pairs = Pairs()
            for b, p in near:
                e = self.x[b] - x[p]
                L = np.linalg.norm(e)
                n = e / L if L > 0 else np.array([0.0, -1.0, 0.0])
                if not overlapping or L < self.R[b]:
                    pairs.add(b, np.array([p]), [1.0], n, L - self.R[b])
            return pairs.rows

        def face_pairs(overlapping):
            pairs = Pairs()
            for b, corners, shares, within, side in faces:
                n, d = self.face_gap(b, x[corners], shares, within, side)
                if not overlapping or d < 0:
                    pairs.add(b, corners, shares, n, d)
            return pairs.rows

        self.exchange(particle_pairs(False), v, start_v, w)
        self.separate(particle_pairs(True), x, w)
        self.exchange(face_pairs(False), v, start_v, w)
        self.separate(face_pairs(True), x, w)
        return x, v

    def distances(self, b, x):
        return np.linalg.norm(x - self.x[b], axis=1)

    def nearest_face(self, b, surface, x):
        """Corners, their shares, whether the place is within the face, and the normal's sign; None without a face."""
        A, B, C = (x[surface.triangles[:, k]] for k in range(3))
        P, limit = self.x[b], self.R[b] + self.world.distance
        wb, wc, within = nearest(P, A, B, C)
        e = P - A - wb[:, None] * (B - A) - wc[:, None] * (C - A)
        L = np.sqrt(dot(e, e))
        g = np.cross(B - A, C - A)
        z = dot(e, g) / np.linalg.norm(g, axis=1)
        if not L.min() < limit:
            return None
        tied = np.flatnonzero(L <= L.min() + 2e-6 * limit)
        straight = np.where(within[tied], 1.0, np.abs(z[tied]) / np.where(L[tied] > 0, L[tied], 1.0))
        t = tied[np.lexsort((L[tied], -straight))[0]]
        shares = np.array([1 - wb[t] - wc[t], wb[t], wc[t]])
        if not within[t] and shares.max() == 1.0:
            return None
        if z[t] < 0 and -z[t] < 0.7 * L[t]:
            return None
        return b, surface.triangles[t], shares, bool(within[t]), -1.0 if z[t] < 0 and not within[t] else 1.0

    def face_gap(self, b, corners, shares, within, side):
        e = self.x[b] - shares @ corners
        if within:
            g = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            n = g / np.linalg.norm(g)
            return n, n @ e - self.R[b]
        L = np.linalg.norm(e)
        return side * e / L, side * L - self.R[b]

    @staticmethod
    def counted(rows, balls, particles):
        of_ball, of_particle = np.zeros(balls), np.zeros(particles)
        for b, others, *_ in rows:
            of_ball[b] += 1
            of_particle[others] += 1
        return of_ball, of_particle

    def weight(self, row, counts, w):
        b, others, shares, *_ = row
        return counts[0][b] * self.w[b] + (shares**2 * counts[1][others] * w[others]).sum()

    def exchange(self, rows, v, start_v, w):
        rows = [row for row in rows if (self.v[row[0]] - row[2] @ v[row[1]]) @ row[3] < 0]
        counts = self.counted(rows, len(self.x), len(v))
        dv_ball, domega, dv = np.zeros_like(self.v), np.zeros_like(self.omega), np.zeros_like(v)
        for row in rows:
            b, others, shares, n, _ = row
            weight = self.weight(row, counts, w)
            relative = self.v[b] - shares @ v[others]
            u = relative @ n
            arrives = -(self.v0[b] - shares @ start_v[others]) @ n >= self.resting
            J = (1 + (self.e if arrives else 0.0)) * -u / weight
            impulse = J * n
            if self.contact["spin"]:
                slip = relative - u * n - np.cross(self.R[b] * self.omega[b], n)
                size = np.linalg.norm(slip)
                if size > 0:
                    t = slip / size
                    J_t = min(self.mu * J, size / (weight + counts[0][b] * self.R[b]**2 / self.I[b]))
                    impulse = impulse - J_t * t
                    domega[b] += self.R[b] / self.I[b] * J_t * np.cross(n, t)
            dv_ball[b] += self.w[b] * impulse
            dv[others] -= (w[others] * shares)[:, None] * impulse
        self.v, self.omega = self.v + dv_ball, self.omega + domega
        v += dv

    def separate(self, rows, x, w):
        counts = self.counted(rows, len(self.x), len(x))
        dx_ball, dx = np.zeros_like(self.x), np.zeros_like(x)
        for row in rows:
            b, others, shares, n, gap = row
            shift = -gap / self.weight(row, counts, w) * n
            dx_ball[b] += self.w[b] * shift
            dx[others] -= (w[others] * shares)[:, None] * shift
        self.x = self.x + dx_ball
        x += dx
