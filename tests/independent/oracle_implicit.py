"""Backward Euler for the independent oracle: v' = v + h a(x + h v', v'), x' = x + h v'.

Coulomb contact belongs to the equation: v' = P(v + h a(x + h v', v')), P being the ground's law for one step
(CoulombStep.project). P has kinks, where a particle lands, leaves, sticks or slips, so the solver is a semismooth
Newton method, with the complete dense Jacobian of the spring forces and of P, taken as far as double precision goes. The
course model's contact force is that of the step's start. Meant for small cubes: each iteration solves a dense system.
"""

import numpy as np

ITERATIONS = 100
HALVINGS = 12
ROUNDING = 1e-13  # m/s


class NotSolved(Exception):
    """The equation of a step was not solved to the accuracy that comparing needs."""


def force_jacobian(world, x0, v):
    """-h df(x0 + h v, v)/dv of springs and drag, as an array (particles, 3, particles, 3)."""
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
    matrix.reshape(3 * count, 3 * count)[np.diag_indices(3 * count)] += np.repeat(h * world.drag * world.m, 3)
    return matrix


def backward_euler(world):
    """The step's end (x', v') before the terrain's response, and by terrain the particles that the ground held."""
    x0, v0, h, count = world.x, world.v, world.h, len(world.x)
    held, contacts = 0.0, None
    if world.model == "course":
        f = world.own_force(v0) + world.spring_force(x0, v0)
        held = world.course_contact_force(x0, v0, f) - f

    def evaluate(v):
        f = world.own_force(v) + world.spring_force(x0 + h * v, v) + held
        if contacts:
            f = f + world.body_contact.react(contacts, v)[0]
        free = v0 + (h * world.w)[:, None] * f
        end, slope, held_by = (world.ground.project(free) if world.ground else
                               (free, np.broadcast_to(np.eye(3), (count, 3, 3)), None))
        return v - end, slope, held_by

    start = world.own_force(v0) + world.spring_force(x0, v0)
    if world.body_contact:
        contacts = world.body_contact.ahead(x0, v0, start, 1)
    world.be_at(1)
    v, held_by = newton(world, evaluate, v0, contacts)
    if contacts:
        # Once more, with the contacts where this ended.
        contacts = world.body_contact.ahead(x0 + h * v, v, start, 2)
        v, held_by = newton(world, evaluate, v, contacts)
    return x0 + h * v, v, held_by


def newton(world, evaluate, v, contacts):
    """The velocities that solve the equation, from v on, and what holds the particles there."""
    x0, count = world.x, len(world.x)
    residual, slope, held_by = evaluate(v)
    best = np.inf, v, held_by
    for _ in range(ITERATIONS):
        size = np.abs(residual).max()
        if size < best[0]:
            best = size, v, held_by
        if size < ROUNDING:
            break
        # d(residual)/dv = I - P' d(free)/dv; a pinned particle has w = 0 and keeps its velocity.
        jacobian = force_jacobian(world, x0, v)
        if contacts:
            jacobian = jacobian + world.body_contact.react(contacts, v)[1]
        through = np.einsum("iab,ibjc->iajc", slope * world.w[:, None, None], jacobian)
        matrix = np.eye(3 * count) + through.reshape(3 * count, 3 * count)
        step = np.linalg.solve(matrix, -residual.ravel()).reshape(v.shape)
        length, before = 1.0, np.linalg.norm(residual)
        for _ in range(HALVINGS):
            trial = evaluate(v + length * step)
            if np.linalg.norm(trial[0]) < before:
                break
            length /= 2
        else:
            if best[0] < 100 * ROUNDING:
                break  # rounding is all that is left
            length, trial = 1.0, evaluate(v + step)  # across a kink the way down may lead uphill
        v = v + length * step
        residual, slope, held_by = trial
    size, v, held_by = best
    if size > 100 * ROUNDING:
        raise NotSolved(f"a residual of {size:.1e} m/s is left after {ITERATIONS} iterations")
    return v, held_by
