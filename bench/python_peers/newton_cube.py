"""A cube of 10³ particles hangs by its top and sags: Newton, with its own springs, on the CPU."""

import newton
import warp
from lattice import lattice

warp.config.quiet = True
x, pairs, top = lattice(10, 4.0)
mass = [1.0] * len(x)
for i in top:
    mass[i] = 0.0
builder = newton.ModelBuilder(up_axis=newton.Axis.Y, gravity=(0.0, -9.8, 0.0))
builder.add_particles(pos=x.tolist(), vel=[(0.0, 0.0, 0.0)] * len(x), mass=mass)
for i, j in pairs.tolist():
    builder.add_spring(i, j, ke=2000.0, kd=60.0, control=0.0)
model = builder.finalize(device="cpu")
model.particle_grid = None
solver = newton.solvers.SolverSemiImplicit(model)
now, later, control = model.state(), model.state(), model.control()


def advance(steps):
    global now, later
    for _ in range(steps):
        now.clear_forces()
        solver.step(now, later, control, None, 0.001)
        now, later = later, now


def positions():
    return now.particle_q.numpy()
