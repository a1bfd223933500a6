"""Bodies of cells and actuators for the independent oracle: springs that follow signals.

A body's cells are numbered over its layers, the empty ones too, by x, y and z: cell (i, j, k) of (X, Y, Z) is (i*Y + j)*Z + k.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from oracle_scene import (YOUNGS_MODULUS_PER_STIFFNESS, SceneError, filled, pinned_mask, rotation_matrix,
                          spring_offsets)

VOXELS = {
    "name": "", "size": 0.5, "position": [0.0, 6.0, 0.0], "rotation": {"axis": [0.0, 1.0, 0.0], "angle": 0.0},
    "velocity": [0.0, 0.0, 0.0], "palette": None, "material": None, "layers": [["1.1", "1.1"], ["111", "111"]],
    "pieces": "refuse", "pinned": [],
}
MATERIAL = {"name": "", "density": 16.0, "youngs-modulus": 33000.0, "damping-ratio": 0.95}
ACTUATOR = {
    "name": "", "body": None, "select": {"material": None, "box": None, "voxels": None, "springs": None}, "axis": "all",
    "amplitude": 0.1, "volume-change": None, "signal": "sine", "frequency": 1.0,
    "table": [[0.0, 0.0], [0.25, 1.0], [0.75, -1.0], [1.0, 0.0]], "phase": None, "start": 0.0, "ramp": 0.0,
}
PHASE = {"offset": 0.0, "along": "none", "wavelength": 1.0, "cells": ""}
LEAST_STRETCH = 0.01


@dataclass
class Cells:
    """What of a body actuators act on: its cells, and each pair of a spring and a cell that has it, with the cell's share
    of the spring's stiffness."""

    names: tuple  # of the body
    shape: tuple
    middles: np.ndarray  # from the body's center, before it is turned
    materials: list  # names, by cell; None where it is empty
    kinds: np.ndarray  # by spring
    squares: np.ndarray  # of the rest vector's direction, (springs, 3)
    spring: np.ndarray
    cell: np.ndarray
    share: np.ndarray


def layers_as_cells(layers):
    """Characters by x, y and z: layers go upwards, rows from back to front, signs from left to right."""
    return np.array([[list(row) for row in layer] for layer in layers]).transpose(2, 0, 1)


def full(cells):
    return ~np.isin(cells, [".", "0", " "])


def largest_piece(cells):
    """The mask of the most cells that hang together by faces."""
    left, best = {tuple(c) for c in np.argwhere(cells)}, set()
    while left:
        piece, todo = set(), [left.pop()]
        while todo:
            cell = todo.pop()
            piece.add(cell)
            for axis, step in itertools.product(range(3), (-1, 1)):
                near = tuple(c + step * (a == axis) for a, c in enumerate(cell))
                if near in left:
                    left.remove(near)
                    todo.append(near)
        best = max(best, piece, key=len)
    mask = np.zeros_like(cells)
    mask[tuple(np.array(sorted(best)).T)] = True
    return mask


def cells_with(point, offset):
    """The groups of cells of which one has the spring from a lattice point over an offset: each group has to be full."""
    steps = max(abs(o) for o in offset)
    ranges = [(p - 1, p) if o == 0 else (min(p, p + o),) for p, o in zip(point, offset)]
    if steps == 1:
        return [[cell] for cell in itertools.product(*ranges)]
    axis = next(a for a, o in enumerate(offset) if o)
    return [[cell, tuple(c + (a == axis) for a, c in enumerate(cell))] for cell in itertools.product(*ranges)]


def found_cells(solid, point, offset):
    """Of these, all cells of the groups that are full."""
    def is_full(cell):
        return all(0 <= c < n for c, n in zip(cell, solid.shape)) and solid[cell]
    return [cell for group in cells_with(point, offset) if all(map(is_full, group)) for cell in group]


def springs_between(solid, index, k_of, c_of, s):
    """Of the points that have a number: a, b, r, k and c of each spring, its kind and the squares of its direction; and pairs
    of springs and cells with the cell's share of k."""
    springs, kinds, squares, pairs = [], [], [], []
    number = np.arange(solid.size).reshape(solid.shape)
    for kind, offsets in spring_offsets().items():
        for offset in offsets:
            length = np.linalg.norm(offset)
            for point, a in index.items():
                own = found_cells(solid, point, offset)
                if not own:
                    continue
                k = [k_of[cell] / len(own) for cell in own]
                pairs += [(len(springs), number[cell], part / sum(k)) for cell, part in zip(own, k)]
                springs.append((a, index[tuple(p + o for p, o in zip(point, offset))], s * length, sum(k),
                                sum(c_of[cell] for cell in own) / len(own)))
                kinds.append(kind)
                squares.append((np.array(offset) / length) ** 2)
    return springs, np.array(kinds), np.array(squares), pairs


def build_voxels(table, materials, readings, where):
    """What build_cube() returns, and the body's Cells."""
    body = filled(table, VOXELS, where)
    s, signs = float(body["size"]), layers_as_cells(body["layers"])
    solid = full(signs)
    if body["pieces"] == "largest":
        solid &= largest_piece(solid)
    elif body["pieces"] == "refuse" and (largest_piece(solid) != solid).any():
        raise SceneError(f"{where} is in several pieces.")
    if body["palette"] is None:
        own = body["material"] or {}
        material = materials[own] if isinstance(own, str) else filled(own, MATERIAL, f"{where}.material")
        of = {sign: material for sign in np.unique(signs)}
    else:
        of = {sign: materials[name] for sign, name in body["palette"].items()}
    facts = np.full(solid.shape, None)
    for cell in map(tuple, np.argwhere(solid)):
        facts[cell] = of[signs[cell]]

    points = sorted({tuple(c + d for c, d in zip(cell, corner)) for cell in map(tuple, np.argwhere(solid))
                     for corner in itertools.product((0, 1), repeat=3)})
    index = {point: i for i, point in enumerate(points)}
    grid = np.array(points)
    per_particle = s ** 3 * solid.sum() / len(points)
    k_of, c_of = np.zeros(solid.shape), np.zeros(solid.shape)
    mass, around = 0.0, [[] for _ in points]
    for cell in map(tuple, np.argwhere(solid)):
        k_of[cell] = facts[cell]["youngs-modulus"] * s / YOUNGS_MODULUS_PER_STIFFNESS
        c_of[cell] = 2 * facts[cell]["damping-ratio"] * np.sqrt(k_of[cell] * facts[cell]["density"] * per_particle / 2)
        mass += facts[cell]["density"] * s ** 3
        for corner in itertools.product((0, 1), repeat=3):
            around[index[tuple(c + d for c, d in zip(cell, corner))]].append(facts[cell]["density"])
    density = np.array([np.mean(near) for near in around])
    m = mass * density / density.sum()

    matrix = rotation_matrix(body["rotation"]["axis"], body["rotation"]["angle"], f"{where}.rotation.axis")
    x = np.array(body["position"], dtype=float) + (s * (grid - np.array(solid.shape) / 2)) @ matrix.T
    low = grid.min(axis=0)
    pinned = pinned_mask(body["pinned"], grid.max(axis=0) - low + 1, grid - low, readings, where)
    v = np.tile(np.array(body["velocity"], dtype=float), (len(grid), 1))
    if readings.pinned_velocity == "zero":
        v[pinned] = 0.0
    springs, kinds, squares, pairs = springs_between(solid, index, k_of, c_of, s)
    names = [material and material["name"] for material in facts.ravel()]
    cells = made_cells((where, body["name"]), solid.shape, s, names, kinds, squares, pairs)
    return ((m, ~pinned, x, v), columns(springs)), cells


def cells_of_cube(table, made, where):
    """Of a cube and the springs that build_cube() made of it: these in the order in which pairs name them, and its Cells."""
    a, b, r, k, c = made
    shape = tuple(table.get("particles") or [table.get("particles-per-edge", 10)] * 3)
    solid = np.ones([n - 1 for n in shape], dtype=bool)
    index = {point: i for i, point in enumerate(itertools.product(*map(range, shape)))}
    s = r.min()
    ones = np.ones(solid.shape)
    springs, kinds, squares, pairs = springs_between(solid, index, ones, ones, s)
    constants = {(i, j): (stiffness, damping) for i, j, stiffness, damping in zip(a.tolist(), b.tolist(), k, c)}
    springs = [(i, j, length, *constants[i, j]) for i, j, length, _, _ in springs]
    name = table.get("material") if isinstance(table.get("material"), str) else None
    cells = made_cells((where,), solid.shape, s, [name or ""] * solid.size, kinds, squares, pairs)
    return columns(springs), cells


def columns(springs):
    a, b, r, k, c = map(np.array, zip(*springs))
    return [a, b, r, k, c]


def made_cells(names, shape, s, materials, kinds, squares, pairs):
    middles = s * (np.array(list(itertools.product(*map(range, shape)))) + 0.5 - np.array(shape) / 2)
    spring, cell, share = map(np.array, zip(*pairs))
    return Cells(names, tuple(shape), middles, materials, kinds, squares, spring, cell, share)


def as_list(value):
    return [value] if isinstance(value, str) else value


class Actuator:
    """A law w(t), and which pairs of a spring and a cell of a body it acts on."""

    def __init__(self, table, where):
        facts = filled(table, ACTUATOR, where)
        phase = facts["phase"]
        self.phase = filled(phase if isinstance(phase, dict) else {"offset": phase or 0.0}, PHASE, f"{where}.phase")
        self.select, self.bodies, self.axis = facts["select"], as_list(facts["body"]), facts["axis"]
        self.signal, self.table = facts["signal"], np.array(facts["table"], dtype=float)
        self.frequency, self.start, self.ramp = (float(facts[key]) for key in ("frequency", "start", "ramp"))
        self.amplitude = float(facts["amplitude"])
        if facts["volume-change"] is not None:
            v = float(facts["volume-change"])
            self.amplitude = (1 + v) ** (1 / 3) - 1 if self.axis == "all" else v

    def pairs(self, cells):
        """A mask over the body's pairs."""
        if self.bodies is not None and not any(name in self.bodies for name in cells.names if name):
            return np.zeros(len(cells.spring), dtype=bool)
        chosen = np.array([material is not None for material in cells.materials])
        if self.select["material"] is not None:
            chosen &= np.array([material in as_list(self.select["material"]) for material in cells.materials])
        if self.select["box"] is not None:
            chosen &= np.all((cells.middles >= self.select["box"]["min"]) & (cells.middles <= self.select["box"]["max"]), axis=1)
        if self.select["voxels"] is not None:
            chosen &= full(layers_as_cells(self.select["voxels"])).ravel()
        of_kind = np.ones(len(cells.kinds), dtype=bool)
        if self.select["springs"] is not None:
            of_kind = np.isin(cells.kinds, self.select["springs"])
        return chosen[cells.cell] & of_kind[cells.spring]

    def phases(self, cells):
        """By cell [cycles]."""
        phase = np.full(len(cells.middles), float(self.phase["offset"]))
        if self.phase["along"] != "none":
            phase -= cells.middles[:, "xyz".index(self.phase["along"])] / self.phase["wavelength"]
        if self.phase["cells"]:
            phase += np.array(self.phase["cells"].split(":")[1].split(), dtype=float)
        return phase

    def w(self, t, phase):
        """At a time [s], of cells with these phases; inputs are 0 here."""
        if t < self.start or self.signal == "input":
            return np.zeros_like(phase)
        theta = self.frequency * (t - self.start) + phase
        u = theta % 1.0
        w = {"sine": lambda: np.sin(2 * np.pi * u), "square": lambda: np.where(u < 0.5, 1.0, -1.0),
             "triangle": lambda: np.interp(u, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0]),
             "table": lambda: np.interp(theta % self.table[-1, 0], *self.table.T)}[self.signal]()
        part = min((t - self.start) / self.ramp, 1.0) if self.ramp > 0 else 1.0
        return w * part ** 2 * (3 - 2 * part)


class Actuation:
    """The rest lengths of all springs at a time."""

    def __init__(self, tables, bodies):
        """`bodies`: the number of each one's first spring, and its Cells."""
        actuators = [Actuator(table, f"actuator[{i}]") for i, table in enumerate(tables)]
        self.bodies = [(first, cells, [(a, a.pairs(cells), a.phases(cells)) for a in actuators]) for first, cells in bodies]

    def lengths(self, at_rest, t):
        r = at_rest.copy()
        for first, cells, drives in self.bodies:
            more = np.zeros((len(cells.spring), 3))
            for actuator, pairs, phases in drives:
                axes = [True] * 3 if actuator.axis == "all" else [axis == actuator.axis for axis in "xyz"]
                more += np.outer(pairs * actuator.amplitude * actuator.w(t, phases)[cells.cell], axes)
            stretch = np.maximum(1 + more, LEAST_STRETCH)
            e = np.sqrt(1 + (cells.squares[cells.spring] * (stretch ** 2 - 1)).sum(axis=1)) - 1
            change = np.bincount(cells.spring, cells.share * e, len(cells.kinds))
            r[first:first + len(cells.kinds)] *= 1 + change
        return r
