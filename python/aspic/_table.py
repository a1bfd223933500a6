"""The runs of a sweep as a table."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ._errors import UsageError
from ._folder import Folder, Row
from ._trajectory import Trajectory

__all__ = ["Table", "collect"]

Path = str | os.PathLike[str]

BEFORE = ("outcome", "reason", "steps")
AFTER = ("hash", "backend", "precision", "aspic", "scene", "key", "solver", "host", "seconds")
"""Columns that may differ between repeats of a run: ``solver``, ``host`` and ``seconds``."""


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)


class Table(Mapping[str, list[Any]]):
    """Runs of a sweep, a column of each key that was varied, of each figure and of each metric.

    ``table["seconds"]`` is a list with a cell for each run; None where it has none. The columns are: the keys that were
    varied; ``outcome`` (``"ok"``, ``"diverged"``, ``"rejected"`` or ``"failed"``), ``reason`` and ``steps``; the
    figures of ``aspic sweep`` (docs/report.md); the metrics; ``hash`` of the last state; and how it was made.
    """

    def __init__(self, rows: Sequence[Row], folder: Path | None = None, keys: Iterable[str] = (), metrics: Iterable[str] = ()):
        self._files = list(rows)
        self._folder = None if folder is None else Folder(folder)
        self.keys_varied: list[str] = list(dict.fromkeys([*keys, *(key for row in rows for key in row["values"])]))
        """Those whose values differ from the scene's."""
        figures = dict.fromkeys(name for row in rows for name in row["figures"])
        named = dict.fromkeys([*metrics, *(name for row in rows for name in row.get("metrics", {}))])
        columns = {key: [row["values"].get(key) for row in rows] for key in self.keys_varied}
        for name in BEFORE:
            columns[name] = [row.get(name) for row in rows]
        for name in figures:
            columns[name] = [row["figures"].get(name) for row in rows]
        for name in named:
            columns[name] = [row.get("metrics", {}).get(name, {}).get("value") for row in rows]
        for name in AFTER:
            columns[name] = [row.get(name) for row in rows]
        self._columns = columns
        self._shown = [*self.keys_varied, "outcome", *named]

    def __getitem__(self, name: str) -> list[Any]:
        if name in self._columns:
            return self._columns[name]
        raise KeyError(f"no column {name!r}; there are {', '.join(self._columns)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Return the number of columns; ``size`` counts runs."""
        return len(self._columns)

    @property
    def size(self) -> int:
        """Number of runs."""
        return len(self._files)

    def rows(self) -> Iterator[dict[str, Any]]:
        """Return each run as a dict of its cells."""
        return (dict(zip(self._columns, cells)) for cells in zip(*self._columns.values()))

    def __repr__(self) -> str:
        counts = {name: self["outcome"].count(name) for name in dict.fromkeys(self["outcome"])}
        return f"<aspic.Table: {self.size} runs ({', '.join(f'{n} {name}' for name, n in counts.items())})>"

    def __str__(self) -> str:
        """Return the first ten runs as text: varied values, outcome and metrics."""
        cells = [self._shown] + [[_cell(self._columns[n][run]) for n in self._shown] for run in range(min(self.size, 10))]
        widths = [max(map(len, column)) for column in zip(*cells)]
        lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in cells]
        return "\n".join([*lines, repr(self)])

    def trajectory(self, run: int) -> Trajectory:
        """Return the trajectory of a run. Raises UsageError if it was not recorded."""
        path = self._folder.trajectory(self["key"][run]) if self._folder else ""
        if not os.path.exists(path):
            raise UsageError(f"run {run} has no trajectory: aspic.sweep(…, trajectories=True, out=…) keeps them")
        return Trajectory.load(path)

    def save(self, path: Path, overwrite: bool = False) -> None:
        """Write ``.csv``, or ``.parquet`` (needs the package pyarrow).

        Raises UsageError for another ending, FileExistsError unless ``overwrite``, and what ``open()`` raises.
        """
        name = os.fspath(path)
        if name.endswith(".csv"):
            import csv

            with open(name, "w" if overwrite else "x", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(self._columns)
                writer.writerows(zip(*self._columns.values()))
        elif name.endswith(".parquet"):
            import pyarrow  # type: ignore[import-not-found, import-untyped, unused-ignore]
            import pyarrow.parquet  # type: ignore[import-not-found, import-untyped, unused-ignore]

            with open(name, "wb" if overwrite else "xb") as file:
                pyarrow.parquet.write_table(pyarrow.table(self._uniform()), file)
        else:
            raise UsageError(f"a table is saved as .csv or .parquet, not as {name!r}")

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame``; needs the package pandas."""
        import pandas  # type: ignore[import-not-found, import-untyped, unused-ignore]

        return pandas.DataFrame(self._uniform())

    def to_xarray(self, trajectories: bool = False) -> Any:
        """Return an ``xarray.Dataset`` with a dimension for each key that was varied; needs the package xarray.

        Where the runs are no grid, it has the one dimension ``run``, and the keys are coordinates. ``trajectories``:
        with those that were kept, over ``time`` (shorter ones, of runs that diverged, end with NaN); the column
        ``time``, when each run ended, is ``end_time`` then.
        """
        import numpy as np
        import xarray  # type: ignore[import-not-found, unused-ignore]

        columns = self._uniform()
        axes = {key: list(dict.fromkeys(columns[key])) for key in self.keys_varied}
        dims, shape = ["run"], [self.size]
        order: Any = np.arange(self.size)
        sizes = [len(values) for values in axes.values()]
        numbers = {key: {value: number for number, value in enumerate(values)} for key, values in axes.items()}
        places = [tuple(numbers[key][columns[key][i]] for key in axes) for i in range(self.size)]
        if axes and len(set(places)) == self.size == int(np.prod(sizes)):
            dims, shape = list(axes), sizes
            run_at = {place: run for run, place in enumerate(places)}
            order = np.array([run_at[place] for place in np.ndindex(*sizes)])
        coordinates: dict[str, Any] = {key: columns[key] for key in axes} if dims == ["run"] else axes
        coordinates = {key: (dims if dims == ["run"] else [key], values) for key, values in coordinates.items()}
        variables: dict[str, Any] = {}
        for name, cells in columns.items():
            if name not in axes:
                variables[name] = (dims, _array(cells)[order].reshape(shape))
        if trajectories:
            time, series = self._trajectories()
            variables = {"end_time" if name == "time" else name: array for name, array in variables.items()}
            coordinates["time"] = (["time"], time)
            for name, array in series.items():
                others = [f"{name}.{i}" for i in range(1, array.ndim - 1)]
                if others and array.shape[-1] == 3:
                    others[-1] = "axis"
                variables[f"{name}(t)"] = ([*dims, "time", *others], array[order].reshape([*shape, *array.shape[1:]]))
        return xarray.Dataset(variables, coords=coordinates)

    def _trajectories(self) -> tuple[Any, dict[str, Any]]:
        """Return the longest time, and the series of all runs (run, time, …)."""
        import numpy as np

        have = [i for i, outcome in enumerate(self["outcome"]) if outcome in ("ok", "diverged")]
        loaded = {i: self.trajectory(i) for i in have}
        time: Any = max((one.time for one in loaded.values()), key=len, default=np.zeros(0))
        series: dict[str, Any] = {}
        for i, one in loaded.items():
            if not np.array_equal(one.time, time[: len(one.time)]):
                raise UsageError("the runs' samples are not of the same times")
            for name, array in one._flat().items():
                if not np.issubdtype(array.dtype, np.number):
                    continue
                if name not in series:
                    series[name] = np.full((self.size, len(time), *array.shape[1:]), np.nan, dtype=array.dtype)
                if series[name].shape[2:] != array.shape[1:]:
                    raise UsageError(f"{name} has other shapes in other runs")
                series[name][i, : len(array)] = array
        return time, series

    def _uniform(self) -> dict[str, list[Any]]:
        """Return columns whose cells have one type each: vectors become text."""
        found = {}
        for name, cells in self._columns.items():
            kinds = {type(cell) for cell in cells if cell is not None}
            if kinds <= {int, float} and float in kinds:
                cells = [None if cell is None else float(cell) for cell in cells]
            elif len(kinds) > 1 or kinds & {list, tuple, dict}:
                cells = [None if cell is None else str(cell) for cell in cells]
            found[name] = cells
        return found


def _array(cells: list[Any]) -> Any:
    import numpy as np

    kinds = {type(cell) for cell in cells if cell is not None}
    if kinds <= {int, float} and (None in cells or float in kinds):
        return np.array([np.nan if cell is None else cell for cell in cells], dtype=float)
    if kinds == {str}:
        return np.array(["" if cell is None else cell for cell in cells])
    return np.array(cells)


def _place(cell: Any) -> tuple[int, Any]:
    """Return the sort key of a cell: numbers, then words, then the rest, then none."""
    if isinstance(cell, (bool, int, float)):
        return 0, cell
    if isinstance(cell, str):
        return 1, cell
    return (3, "") if cell is None else (2, str(cell))


def collect(folder: Path) -> Table:
    """Return the table of all runs in a folder of ``aspic.sweep()`` or ``aspic sweep --runs``, also of several sweeps.

    Rows are sorted by the values of the keys that were varied. Files that are damaged are left out. Raises FileError
    where it is no such folder.
    """
    place = Folder(folder)
    rows = [row for row in map(place.read, sorted(place.keys())) if row is not None]
    keys = list(dict.fromkeys(key for row in rows for key in row["values"]))
    rows.sort(key=lambda row: [*(_place(row["values"].get(key)) for key in keys), (4, row["key"])])
    return Table(rows, folder, keys)
