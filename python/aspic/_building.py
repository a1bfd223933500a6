"""Parts that are added to a scene."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from ._errors import SceneError, UsageError
from ._toml import assignments

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["Buildable"]


class Buildable:
    """The part of a scene that takes further elements. Each method adds one or, if it raises, leaves the scene alone.

    Values are those of scene files (docs/scene-reference.md), lists and arrays of numpy included; None: the default.
    Further keys are named with ``_`` for ``-``: ``scene.add("cube", edge_length=1.0)``.
    """

    def _count(self, kind: str) -> int:
        """Return the number of elements of a list of the scene."""
        raise NotImplementedError

    def _extend(self, words: list[str]) -> None:
        """Apply arguments of --set."""
        raise NotImplementedError

    def update(self, values: Mapping[str, Any]) -> None:
        """Set several keys."""
        raise NotImplementedError

    def add(self, kind: str, values: Mapping[str, Any] | None = None, /, **more: Any) -> str:
        """Add an element to a list of the scene; return its path, ``"cube[1]"``, or ``"voxels[worm]"`` by its name.

        ``kind``: ``"cube"``, ``"voxels"``, ``"cloth"``, ``"goal-net"``, ``"terrain"``, ``"ball"``, ``"launcher"``,
        ``"material"`` or another ``[[…]]`` of scene files; ``values`` and ``more``: its keys, ``{"edge-length": 1.0}``
        or ``edge_length=1.0``; the others have their defaults. Raises SceneError for what a scene refuses.
        """
        keys = {**(values or {}), **{key.replace("_", "-"): value for key, value in more.items()}}
        given = {key: value for key, value in keys.items() if value is not None}
        self.update({f"{kind}[+]": given})
        if given.get("name"):
            return f"{kind}[{given['name']}]"
        return f"{kind}[{self._count(kind) - 1}]"

    def add_many(self, kind: str, elements: Iterable[Mapping[str, Any]], /) -> list[str]:
        """Add several elements to a list of the scene at once, which is faster than one by one; return their paths.

        ``kind``, and the keys and values of each of the ``elements``: as of ``add()``. Raises SceneError, and then none
        is added.
        """
        given = [{key: value for key, value in keys.items() if value is not None} for keys in elements]
        first = self._count(kind)
        if given:
            self._extend([word for keys in given for word in assignments({f"{kind}[+]": keys})])
        return [f"{kind}[{keys.get('name') or first + n}]" for n, keys in enumerate(given)]

    def add_material(
        self,
        name: str,
        *,
        density: float | None = None,
        youngs_modulus: float | None = None,
        damping_ratio: float | None = None,
    ) -> str:
        """Add a material, which bodies use by its name; return its path, ``"material[muscle]"``.

        ``density``: ρ [kg/m³], > 0; ``youngs_modulus``: E [Pa], > 0, which means the same at every resolution;
        ``damping_ratio``: ζ, ≥ 0 (docs/physics.md, *Materials*). Raises SceneError, also where the name is taken.
        """
        values = {"density": density, "youngs-modulus": youngs_modulus, "damping-ratio": damping_ratio}
        return self.add("material", {"name": name, **values})

    def add_voxels(
        self,
        name: str,
        cells: ArrayLike | Sequence[Sequence[str]],
        *,
        size: float | None = None,
        palette: Mapping[Any, str] | None = None,
        material: str | Mapping[str, float] | None = None,
        position: ArrayLike | None = None,
        pieces: str | None = None,
        pinned: Iterable[Any] | None = None,
        **more: Any,
    ) -> str:
        """Add a body of cubic cells; return its path, ``"voxels[worm]"``.

        ``cells``: whole numbers or bool, (nx, ny, nz) along x, y (upwards) and z, 0 where a cell is empty, at most 512
        along each axis; or layers of rows of characters as in files. ``size``: edge of a cell [m], > 0; ``palette``:
        the material's name of each number or character, ``{1: "muscle", 2: "fat"}``; ``material``: without a palette,
        that of all cells, a name or ``{"density": 900.0}``; ``position``: center of the array's box [m], (3,);
        ``pieces``: of cells that share no face, ``"refuse"``, ``"largest"`` or ``"all"``; ``pinned``: faces, corners
        and indices of particles that never move. Raises UsageError for cells that are no array, SceneError for what a
        scene refuses: a number that the palette does not name, several pieces, a name that is taken.
        """
        values = {
            "name": name,
            "size": size,
            "palette": palette and {str(key): of for key, of in palette.items()},
            "material": material,
            "position": position,
            "pieces": pieces,
            "pinned": None if pinned is None else list(pinned),
        }
        if _are_layers(cells):
            return self.add("voxels", {**values, "layers": cells}, **more)
        with tempfile.TemporaryDirectory() as folder:
            file = _saved(folder, "cells", cells)
            try:
                return self.add("voxels", {**values, "file": file}, **more)
            except SceneError as error:
                raise SceneError(_unsaved(str(error), folder)) from None

    def add_mesh(
        self,
        name: str,
        path: str | os.PathLike[str],
        *,
        cells: int | None = None,
        height: float | None = None,
        up: str | None = None,
        material: str | Mapping[str, float] | None = None,
        position: ArrayLike | None = None,
        pieces: str | None = None,
        **more: Any,
    ) -> str:
        """Add the inside of a mesh as a body of cells, drawn as the mesh; return its path, ``"voxels[bunny]"``.

        ``path``: .obj, .stl or .ply, or ``"rabbit"``, which is built in; ``cells``: along the longest edge of its box,
        1 … 256; ``height``: of the box, to which the mesh is scaled [m], None: the file's numbers are meters; ``up``:
        the file's axis that points upwards, ``"y"`` or ``"z"``; ``material``, ``position``, ``pieces``: as of
        ``add_voxels()``. ``notes`` says what was repaired. Raises SceneError for a file that cannot be read, with its
        line or byte, and for a mesh of which no inside can be told, with its figures (docs/meshes.md).
        """
        values = {"name": name, "mesh": os.fspath(path), "cells": cells, "height": height, "up": up}
        return self.add("voxels", {**values, "material": material, "position": position, "pieces": pieces}, **more)

    def add_actuator(
        self,
        name: str,
        *,
        body: str | Sequence[str] | None = None,
        material: str | Sequence[str] | None = None,
        box: tuple[ArrayLike, ArrayLike] | None = None,
        voxels: ArrayLike | None = None,
        springs: Sequence[str] | None = None,
        axis: str | None = None,
        amplitude: float | None = None,
        volume_change: float | None = None,
        signal: str | None = None,
        frequency: float | None = None,
        table: ArrayLike | None = None,
        phase: float | Mapping[str, Any] | ArrayLike | None = None,
        start: float | None = None,
        ramp: float | None = None,
    ) -> str:
        """Add an actuator, which makes springs' rest lengths follow a signal; return its path, ``"actuator[legs]"``.

        r(t) = r₀(1 + a·w(t)) for the springs of chosen cells (docs/actuation.md). ``body``: one or several names, None:
        every body; ``material``: names of the cells' materials, ``box``: two corners (3,) around the middles of cells,
        from the body's center [m], ``voxels``: a mask (nx, ny, nz), ``springs``: ``"structural"``, ``"shear"``,
        ``"bending"``: what it acts on, all that are given together; ``axis``: ``"all"``, ``"x"``, ``"y"`` or ``"z"`` of
        the body; ``amplitude``: a, or ``volume_change``: v at w = 1; ``signal``: w, ``"sine"``, ``"square"``,
        ``"triangle"``, ``"table"`` or ``"input"``, which ``Simulation.inputs`` gives; ``frequency`` [Hz]; ``table``:
        (n, 2), times in periods and w; ``phase`` [cycles]: a number, ``{"along": "x", "wavelength": 0.1}``, or an array
        (nx, ny, nz) with one for each cell; ``start``: before it w is 0 [s]; ``ramp``: w then grows so long [s]. Raises
        SceneError for what a scene refuses, UsageError for arrays that hold no numbers.
        """
        with tempfile.TemporaryDirectory() as folder:
            select = {
                "material": material,
                "box": None if box is None else {"min": box[0], "max": box[1]},
                "voxels": None if voxels is None else _saved(folder, "mask", voxels),
                "springs": springs,
            }
            if phase is not None and not isinstance(phase, (int, float, Mapping)):
                phase = _saved(folder, "phase", phase)
            values = {
                "name": name,
                "body": body,
                "select": {key: value for key, value in select.items() if value is not None} or None,
                "axis": axis,
                "amplitude": amplitude,
                "volume-change": volume_change,
                "signal": signal,
                "frequency": frequency,
                "table": table,
                "phase": phase,
                "start": start,
                "ramp": ramp,
            }
            try:
                return self.add("actuator", values)
            except SceneError as error:
                raise SceneError(_unsaved(str(error), folder)) from None


def _saved(folder: str, name: str, array: ArrayLike) -> str:
    """Write an array to a file that the library reads, so that one reader gives all messages."""
    import numpy as np

    file = os.path.join(folder, f"{name}.npy")
    try:
        np.save(file, np.asarray(array), allow_pickle=False)
    except ValueError as error:
        raise UsageError(f"{name}: an array of numbers, (nx, ny, nz): {error}") from None
    return file


def _unsaved(message: str, folder: str) -> str:
    """Return a message that names the array in place of its file."""
    return re.sub(rf'"{re.escape(folder + os.sep)}(\w+)\.npy"', r"\1", message)


def _are_layers(cells: Union[ArrayLike, Sequence[Sequence[str]]]) -> bool:
    inner: Any = cells
    while isinstance(inner, (list, tuple)) and inner:
        inner = inner[0]
    return isinstance(inner, str)
