"""The lattice in Warp, as its own integrators did it: a kernel over the list of springs that adds to the forces of both
ends, and a kernel that moves the particles. ASPIC_PEER_DEVICE is cpu, also if it is unset, or cuda."""
import os

from peer import converse

import numpy
import warp as wp


@wp.kernel
def spring_forces(x: wp.array(dtype=wp.vec3), v: wp.array(dtype=wp.vec3), ends: wp.array(dtype=wp.vec2i),
                  rest_length: wp.array(dtype=float), k: float, c: float, f: wp.array(dtype=wp.vec3)):
    s = wp.tid()
    a = ends[s][0]
    b = ends[s][1]
    e = x[a] - x[b]
    distance = wp.length(e)
    d = e / distance
    force = (k * (distance - rest_length[s]) + c * wp.dot(v[a] - v[b], d)) * d
    wp.atomic_sub(f, a, force)
    wp.atomic_add(f, b, force)


@wp.kernel
def move(x: wp.array(dtype=wp.vec3), v: wp.array(dtype=wp.vec3), f: wp.array(dtype=wp.vec3), gravity: wp.vec3,
         inverse_mass: float, h: float):
    i = wp.tid()
    x[i] = x[i] + h * v[i]
    v[i] = v[i] + h * (gravity + inverse_mass * f[i])
    f[i] = wp.vec3()


class Peer:
    def __init__(self, lattice):
        wp.config.quiet = True
        wp.config.kernel_cache_dir = os.path.join(os.path.dirname(__file__), "../../build/peers/warp")
        wp.init()
        self.lattice = lattice
        self.device = os.environ.get("ASPIC_PEER_DEVICE", "cpu")
        ends, lengths = lattice.springs()
        self.springs = len(lengths)

        def array(values, dtype):
            return wp.array(values, dtype=dtype, device=self.device)

        self.start = array(lattice.start().astype(numpy.float32), wp.vec3)
        self.x, self.v, self.f = (wp.zeros_like(self.start) for _ in range(3))
        self.ends, self.lengths = array(ends.astype(numpy.int32), wp.vec2i), array(lengths.astype(numpy.float32), float)
        gravity = wp.vec3(0.0, -lattice.gravity, 0.0)
        self.load()
        self.commands = [
            wp.launch(spring_forces, dim=self.springs, device=self.device, record_cmd=True,
                      inputs=[self.x, self.v, self.ends, self.lengths, lattice.stiffness, lattice.damping, self.f]),
            wp.launch(move, dim=len(self.start), device=self.device, record_cmd=True,
                      inputs=[self.x, self.v, self.f, gravity, 1.0 / lattice.mass, lattice.timestep])]
        # On a card a step is one launch, of a graph.
        self.graph = None
        if self.device != "cpu":
            self.step()
            self.load()
            with wp.ScopedCapture(device=self.device) as capture:
                self.step()
            self.graph = capture.graph

    def hello(self):
        return {"name": "warp", "version": wp.__version__, "threads": 1, "integrator": "explicit-euler",
                "damping": self.lattice.damping, "deviation": 0.0}

    def load(self):
        wp.copy(self.x, self.start)
        self.v.zero_()
        self.f.zero_()

    def advance(self, steps):
        for _ in range(steps):
            if self.graph:
                wp.capture_launch(self.graph)
            else:
                self.step()
        wp.synchronize()

    def step(self):
        for command in self.commands:
            command.launch()

    def positions(self):
        return self.x.numpy()


converse(Peer)
