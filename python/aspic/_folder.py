"""Where the runs of a sweep are kept: a file each, complete or not there."""

from __future__ import annotations

import io
import json
import os
from typing import TYPE_CHECKING, Any

from . import _aspic
from ._errors import FileError
from ._scene import Scene

if TYPE_CHECKING:
    from ._trajectory import Trajectory

__all__ = ["Folder"]

Row = dict[str, Any]
"""Contents of a run's file (docs/sweeps.md)."""


class Folder:
    """A folder of runs: ``runs/KEY.json``, ``runs/KEY.npz``, ``scenes/KEY.toml``, as the library keeps them."""

    def __init__(self, path: str | os.PathLike[str]):
        self.path = os.path.abspath(path)
        self._core = _aspic.RunFolder(self.path)

    def make(self, scene: Scene) -> None:
        """Create the folder if it is missing, with its base scene. Raises FileError."""
        self._core.make(scene._core)

    def has(self, scene: Scene) -> bool:
        """Return whether the base scene is in the folder, which identifies it on another machine."""
        return os.path.exists(os.path.join(self.path, "scenes", f"{_aspic.scene_key(scene._core)}.toml"))

    def keys(self) -> set[str]:
        """Return the keys of finished runs. Raises FileError."""
        try:
            names = os.listdir(os.path.join(self.path, "runs"))
        except OSError as error:
            raise FileError(f"{self.path} is no folder of runs: {error.strerror}") from error
        return {name[:-5] for name in names if name.endswith(".json") and not name.startswith(".")}

    def read(self, key: str) -> Row | None:
        """Return a finished run, or None if its file is missing, damaged or not a regular file."""
        text = self._core.read(key)
        return None if text is None else json.loads(text)

    def write(self, row: Row, trajectory: Trajectory | None = None) -> None:
        """Write a run, and replace an existing one. Raises FileError."""
        if trajectory is not None:
            content = io.BytesIO()
            trajectory._write(content)
            self._core.write(row["key"], "npz", content.getvalue())
        self._core.write(row["key"], "json", (json.dumps(row, indent=1, allow_nan=False) + "\n").encode())

    def trajectory(self, key: str) -> str:
        """Return the path of a run's trajectory, which may be missing."""
        return self._core.file(key, "npz")
