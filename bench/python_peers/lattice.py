"""The cube as a list of springs, for simulators without such a body."""

import itertools

import numpy as np


def lattice(n, edge):
    """Positions [n³, 3], pairs of particles with a spring [s, 2], and which particles are on top [n³]."""
    axis = np.linspace(-edge / 2, edge / 2, n)
    positions = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    index = np.arange(n**3).reshape(n, n, n)
    pairs = []
    for offset in itertools.product(range(-2, 3), repeat=3):
        straight = sorted(map(abs, offset)) == [0, 0, 2]
        if offset > (0, 0, 0) and (max(map(abs, offset)) == 1 or straight):
            low = tuple(slice(max(0, -o), n - max(0, o)) for o in offset)
            high = tuple(slice(max(0, o), n - max(0, -o)) for o in offset)
            pairs.append(np.stack([index[low].ravel(), index[high].ravel()], axis=1))
    return positions, np.concatenate(pairs), index[:, -1, :].ravel()
