"""Where the runs of a sweep are kept: a file each, complete or not there."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import _aspic
from ._errors import FileError
from ._scene import Scene

if TYPE_CHECKING:
    from ._trajectory import Trajectory

__all__ = ["Folder"]

Row = dict[str, Any]
"""What a run's file holds (docs/sweeps.md)."""

_counter = itertools.count()


class Folder:
    """A folder of runs: ``runs/KEY.json``, ``runs/KEY.npz``, ``scenes/KEY.toml``. ``aspic sweep --runs`` has the same.

    Two processes on two machines may write at once: a file has a temporary name until it is complete.
    """

    def __init__(self, path: str | os.PathLike[str]):
        self.path = os.path.abspath(path)

    def make(self, scene: Scene) -> None:
        """Makes it where there is none, with the scene that runs differ from. Raises FileError."""
        try:
            os.makedirs(os.path.join(self.path, "runs"), exist_ok=True)
            os.makedirs(os.path.join(self.path, "scenes"), exist_ok=True)
            if not self.has(scene):
                text = scene.toml.encode()
                self._write(self._scene(_aspic.scene_key(scene._core)), lambda file: file.write(text))
        except OSError as error:
            raise FileError(f"cannot make the folder {self.path}: {error.strerror}") from error

    def has(self, scene: Scene) -> bool:
        """Whether the scene is there. On another machine: whether this is the sweep's folder."""
        return os.path.exists(self._scene(_aspic.scene_key(scene._core)))

    def keys(self) -> set[str]:
        """The runs that are there. Raises FileError."""
        try:
            names = os.listdir(os.path.join(self.path, "runs"))
        except OSError as error:
            raise FileError(f"{self.path} is no folder of runs: {error.strerror}") from error
        return {name[:-5] for name in names if name.endswith(".json") and not name.startswith(".")}

    def read(self, key: str) -> Row | None:
        """Return a finished run, or None if its file is missing, damaged or not a regular file."""
        path = self._run(key, "json")
        if not os.path.isfile(path):  # opening a pipe would wait for its writer
            return None
        try:
            with open(path, encoding="utf-8") as file:
                row = json.load(file)
        except (OSError, ValueError, RecursionError):
            return None
        if not isinstance(row, dict) or row.get("key") != key or not isinstance(row.get("outcome"), str):
            return None
        tables = [row.get("values"), row.get("figures"), row.get("metrics", {})]
        if not all(isinstance(table, dict) for table in tables):
            return None
        return row if all(isinstance(metric, dict) for metric in tables[2].values()) else None

    def write(self, row: Row, trajectory: Trajectory | None = None) -> None:
        """Keeps a run; one that is there is replaced. Raises OSError."""
        key = row["key"]
        if trajectory is not None:
            self._write(self._run(key, "npz"), trajectory._write)
        text = (json.dumps(row, indent=1, allow_nan=False) + "\n").encode()
        self._write(self._run(key, "json"), lambda file: file.write(text))

    def trajectory(self, key: str) -> str:
        """The path of a run's trajectory, whether it is there or not."""
        return self._run(key, "npz")

    def _run(self, key: str, kind: str) -> str:
        return os.path.join(self.path, "runs", f"{key}.{kind}")

    def _scene(self, key: str) -> str:
        return os.path.join(self.path, "scenes", f"{key}.toml")

    @staticmethod
    def _write(path: str, fill: Callable[[Any], Any]) -> None:
        import socket

        folder, name = os.path.split(path)
        # Processes of several machines may have one number.
        temporary = os.path.join(folder, f".{name}-{socket.gethostname()}-{os.getpid()}-{next(_counter)}.tmp")
        try:
            with open(temporary, "xb") as file:
                fill(file)
            os.replace(temporary, path)
        except BaseException:
            try:
                os.remove(temporary)
            except OSError:
                pass
            raise
