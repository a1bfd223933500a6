"""Backward Euler for the independent oracle: v' = v + h a(x + h v', v'), x' = x + h v'.

Newton's method with the complete dense Jacobian of the spring forces, taken as far as double precision goes. The
course model's contact force is that of the step's start. Meant for small cubes: each iteration solves a dense system.
"""

import numpy as np

ITERATIONS = 60
HALVINGS = 20


def defect(world, held, v0, x0, v):
    """m (v - v0) - h f(x0 + h v, v), zero at the solution; rows of pinned particles are zero."""
    f = world.m[:, None] * world.gravity + world.spring_force(x0 + world.h * v, v) + held
    return np.where(world.free[:, None], world.m[:, None] * (v - v0) - world.h * f, 0.0)


def jacobian(world, x0, v):
    """d(defect)/dv as a dense matrix; pinned particles get unit rows and columns, so that they stay."""
    h, count = world.h, len(x0)
    rate = v[world.a] - v[world.b]
    e = x0[world.a] - x0[world.b] + h * rate
    length = np.sqrt(np.einsum("ij,ij->i", e, e))
    acting = length > 0
    length = np.where(acting, length, 1.0)
    n = e / length[:, None]
    tension = world.k * (length - world.r) + world.c * np.einsum("ij,ij->i", rate, n)
    nn = n[:, :, None] * n[:, None, :]
    across = (np.eye(3) - nn) / length[:, None, None]
    # The tension pulls along n; it changes with the length (k), with the speed along n (c), and because n turns under a
    # relative speed that stays as it is.
    turning = np.einsum("sij,sj->si", across, rate)
    change = (h * world.k + world.c)[:, None] * n + (h * world.c)[:, None] * turning
    block = h * (n[:, :, None] * change[:, None, :] + (h * tension)[:, None, None] * across)
    block[~acting] = 0.0
    matrix = np.zeros((count, 3, count, 3))
    for p, q, sign in ((world.a, world.a, 1), (world.b, world.b, 1), (world.a, world.b, -1), (world.b, world.a, -1)):
        np.add.at(matrix, (p, slice(None), q), sign * block)
    index = np.arange(count)
    matrix[index, :, index, :] += world.m[:, None, None] * np.eye(3)
    matrix[~world.free] = 0.0
    matrix[:, :, ~world.free] = 0.0
    for i in np.flatnonzero(~world.free):
        matrix[i, :, i, :] = np.eye(3)
    return matrix.reshape(3 * count, 3 * count)


def backward_euler(world):
    """The step's end (x', v') before the terrain's response."""
    x0, v0 = world.x, world.v
    held = 0.0
    if world.model == "course":
        f = world.m[:, None] * world.gravity + world.spring_force(x0, v0)
        held = world.course_contact_force(x0, v0, f) - f
    v = v0
    F = defect(world, held, v0, x0, v)
    for _ in range(ITERATIONS):
        size = np.linalg.norm(F)
        if np.abs(F).max() < 1e-13:
            break
        step = np.linalg.solve(jacobian(world, x0, v), -F.ravel()).reshape(v.shape)
        for _ in range(HALVINGS):
            trial = v + step
            F_trial = defect(world, held, v0, x0, trial)
            if np.linalg.norm(F_trial) < size:
                break
            step = step / 2
        else:
            break  # rounding is all that is left
        v, F = trial, F_trial
    return x0 + world.h * v, v
