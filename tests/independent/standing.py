#!/usr/bin/env python3
"""How a cube stands: its height and its shortest links, from a state CSV.

usage: standing.py STATE.csv PARTICLES_PER_EDGE EDGE_LENGTH

Reads nothing but the file that `aspic run --state` writes. Exit code 1 unless the cube, not rotated at its start,
stands above 0.9 of its edge with no link between axis neighbors inverted and no cell turned inside out.
"""
import csv
import sys

import numpy as np


def main() -> int:
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    path, n, edge = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "particle"]
    if len(rows) != n**3:
        print(f"{path} holds {len(rows)} particles, not {n**3}", file=sys.stderr)
        return 2
    x = np.array([[float(r["x"]), float(r["y"]), float(r["z"])] for r in rows]).reshape(n, n, n, 3)
    v = np.array([[float(r["vx"]), float(r["vy"]), float(r["vz"])] for r in rows])
    spacing = edge / (n - 1)
    columns = x[:, -1, :, 1] - x[:, 0, :, 1]
    along = [np.diff(x, axis=axis)[..., axis] / spacing for axis in range(3)]
    first = x[:-1, :-1, :-1]
    edges = (x[1:, :-1, :-1] - first, x[:-1, 1:, :-1] - first, x[:-1, :-1, 1:] - first)
    volume = np.einsum("...i,...i", edges[0], np.cross(edges[1], edges[2])) / spacing**3
    inverted = int(sum((a <= 0).sum() for a in along)) + int((volume <= 0).sum())
    print(f"height        {columns.mean():.4f} m, {columns.mean() / edge:.4f} of the edge; lowest column {columns.min():.4f} m")
    print(f"links         {min(a.min() for a in along):.4f} of the spacing along their axis at least")
    print(f"cells         {volume.min():.4f} of their volume at least")
    print(f"inverted      {inverted}")
    print(f"fastest       {np.linalg.norm(v, axis=1).max():.4f} m/s")
    return 0 if columns.mean() > 0.9 * edge and inverted == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
