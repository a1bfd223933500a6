"""The lattice in Taichi, as its own examples of cloth do it: every particle looks at its neighbors in the grid, at
offsets known when the kernel is compiled. ASPIC_PEER_DEVICE is cpu, also if it is unset, or cuda."""
import math
import os

from peer import converse, offsets

import taichi as ti


class Peer:
    def __init__(self, lattice):
        device = getattr(ti, os.environ.get("ASPIC_PEER_DEVICE", "cpu"))
        ti.init(arch=device, cpu_max_num_threads=lattice.threads, default_fp=ti.f32, log_level=ti.WARN)
        self.lattice = lattice
        n, h, m = lattice.size, lattice.timestep, lattice.mass
        k, c, g = lattice.stiffness, lattice.damping, lattice.gravity
        half = offsets()
        neighbors = [(o, lattice.spacing * math.sqrt(sum(d * d for d in o)))
                      for o in half + [tuple(-d for d in o) for o in half]]
        self.springs = len(lattice.springs()[0])
        x = ti.Vector.field(3, ti.f32, shape=(n, n, n))
        v = ti.Vector.field(3, ti.f32, shape=(n, n, n))
        a = ti.Vector.field(3, ti.f32, shape=(n, n, n))

        @ti.kernel
        def step():
            for i in ti.grouped(x):
                force = ti.Vector([0.0, -m * g, 0.0])
                for o, length in ti.static(neighbors):
                    j = i + ti.Vector(o)
                    if 0 <= j[0] < n and 0 <= j[1] < n and 0 <= j[2] < n:
                        e = x[i] - x[j]
                        distance = e.norm()
                        d = e / distance
                        force -= (k * (distance - length) + c * (v[i] - v[j]).dot(d)) * d
                a[i] = force / m
            for i in ti.grouped(x):
                x[i] += h * v[i]
                v[i] += h * a[i]

        self.x, self.v, self.step = x, v, step
        self.start = lattice.start().reshape(n, n, n, 3).astype("float32")
        self.load()
        step()

    def hello(self):
        return {"name": "taichi", "version": ".".join(map(str, ti.__version__)), "threads": self.lattice.threads,
                "integrator": "explicit-euler", "damping": self.lattice.damping, "deviation": 0.0}

    def load(self):
        self.x.from_numpy(self.start)
        self.v.fill(0.0)
        ti.sync()

    def advance(self, steps):
        for _ in range(steps):
            self.step()
        ti.sync()

    def positions(self):
        return self.x.to_numpy().reshape(-1, 3)


converse(Peer)
