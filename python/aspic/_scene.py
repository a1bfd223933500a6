"""Scenes: physics and view of one TOML file."""

from __future__ import annotations

import difflib
import functools
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, NoReturn

from . import _aspic, _program
from ._building import Buildable
from ._errors import FileError, SceneError, UsageError
from ._toml import assignments

__all__ = ["BuiltinScene", "Parameter", "Scene", "load", "parameters", "scenes"]


class BuiltinScene(NamedTuple):
    """A scene that is part of the library."""

    name: str
    """As ``load()`` takes it."""
    description: str
    """A line."""
    group: str
    """The heading that it is listed under."""


class Parameter(NamedTuple):
    """A key of scene files; docs/scene-reference.md lists them all."""

    path: str
    """``simulation.timestep``, ``cube[].shear.stiffness``; ``[]`` is an index."""
    meaning: str
    """A sentence."""
    unit: str
    """SI unit; empty: a pure number, or no number."""
    allowed: str
    """In words."""
    default: str
    """As TOML, or in words."""
    live: bool
    """May change while a simulation runs: ``Simulation.update()``."""


def scenes() -> list[BuiltinScene]:
    """Return all built-in scenes, in the order of ``aspic scene list``."""
    return [BuiltinScene(*row) for row in _aspic.builtin_scenes()]


def parameters() -> list[Parameter]:
    """Return every key that a scene may have, in the order of files."""
    return [Parameter(*row) for row in _aspic.parameters()]


@functools.cache
def _of_the_start() -> frozenset[str]:
    """Return the keys that only define the start of a run or its bodies."""
    return frozenset(parameter.path for parameter in parameters() if not parameter.live)


def changes(values: Mapping[str, Any]) -> list[str]:
    """Return keys and values that may change during a run, as arguments of --set. Raises UsageError for others."""
    words = assignments(values)
    for key in values:
        if re.sub(r"\[[^]]*\]", "[]", key) in _of_the_start():
            raise UsageError(
                f"{key} is of the start: it cannot change while a simulation runs. Assign positions and velocities, or "
                "make a new simulation of a changed scene"
            )
    return words


class Scene(Buildable):
    """Physics and view of one scene file.

    Keys are the paths of ``--set``: ``scene["simulation.timestep"] = 0.0005``. Units are those of SI; every key, its
    unit, range and meaning is in ``aspic.parameters()`` and docs/scene-reference.md. The order of keys is that of
    files.
    """

    _read: _aspic.Scene  # of a draft there is none
    _empty: SceneError

    def __init__(self, text: str = "schema = 1\n", name: str = "scene", overrides: Mapping[str, Any] | None = None):
        """Read TOML text.

        ``name``: for messages, and for titles where the text gives none; ``overrides``: keys and values set afterwards.
        Raises SceneError with every mistake, its line and the nearest word. A scene in which nothing moves yet may be
        built by ``add()`` and ``update()``; whatever else is asked of it raises SceneError until something does.
        """
        self._notes: list[str] = []
        self._draft: tuple[str, str, list[str]] | None = (text, name, [])
        self._extend(assignments(overrides))

    def _extend(self, words: list[str]) -> None:
        """Apply arguments of --set; an empty scene stores them until it has a body."""
        if self._draft is None:
            self._read, notes = self._read.with_overrides(words)
        else:
            text, name, before = self._draft
            try:
                self._read, notes = _aspic.Scene.parse(text, name, before + words)
            except SceneError as error:
                if any("the scene is empty" not in line for line in str(error).splitlines() if line[:1] != " "):
                    raise
                self._draft, self._empty = (text, name, before + words), error
                return
            self._draft = None
        self._notes += notes

    def _count(self, kind: str) -> int:
        if self._draft is not None:
            text, _, words = self._draft
            return text.count(f"[[{kind}]]") + sum(word.startswith(f"{kind}[+]=") for word in words)
        return len({key[: key.index("]")] for key in self.keys() if key.startswith(f"{kind}[")})

    @property
    def _core(self) -> _aspic.Scene:
        if self._draft is not None:
            raise SceneError(str(self._empty))
        return self._read

    @classmethod
    def _of(cls, core: _aspic.Scene, notes: Iterable[str] = ()) -> Scene:
        scene = cls.__new__(cls)
        scene._read, scene._notes, scene._draft = core, list(notes), None
        return scene

    @property
    def name(self) -> str:
        """Name of the scene, for titles and reports."""
        return self._core.name

    @property
    def toml(self) -> str:
        """Complete scene file with units as comments; reading it gives the same values to the bit."""
        return self._core.to_toml()

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies: ``cube[0]``, ``voxels[0]``, ``goal-net[0]``, ``cloth[0]``."""
        return self._core.bodies()

    @property
    def notes(self) -> list[str]:
        """Repairs and conversions of meshes, a sentence each, since the scene was read."""
        return list(self._notes)

    def __getitem__(self, key: str) -> Any:
        """Return the value of a key: a number, word, tuple (vectors) or list; None if absent or meaningless here.
        For a table, ``scene["simulation"]``, it is a dict of its keys.

        Raises SceneError (a ValueError) for an unknown key, with the nearest one.
        """
        try:
            return self._core.value(key)
        except SceneError as error:
            table = {path[len(key) + 1 :]: path for path in self.keys() if path.startswith(f"{key}.")}
            if table:
                return {path: self._core.value(full) for path, full in table.items()}
            # The library asks --set, which takes a value.
            raise SceneError(str(error).replace(f"{key}=0", key)) from None

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value of a key; ``default`` where the scene has no such key."""
        return self[key] if key in self else default

    def items(self) -> list[tuple[str, Any]]:
        """Return every key with its value."""
        return [(key, self._core.value(key)) for key in self.keys()]

    def values(self) -> list[Any]:
        """Return the value of every key."""
        return [value for _, value in self.items()]

    def __delitem__(self, key: str) -> NoReturn:
        raise SceneError(
            f"{key!r} cannot be removed from a scene: set it to its default, which aspic.parameters() lists, or build a "
            "scene without it"
        )

    def __setitem__(self, key: str, value: Any) -> None:
        """Set a key; a dict sets several of a table.

        Raises SceneError (a ValueError), and then the scene is as before: an unknown key, with the nearest one; a value
        of another kind or out of range.
        """
        self.update({key: value})

    def update(self, values: Mapping[str, Any]) -> None:
        """Set several keys at once: all, or none if it raises SceneError. Keys may depend on each other."""
        self._extend(assignments(values))

    def copy(self, values: Mapping[str, Any] | None = None) -> Scene:
        """Return another scene with the same values, except those given. Raises SceneError."""
        other = Scene.__new__(Scene)
        other.__dict__.update(self.__dict__, _notes=list(self._notes))
        if values:
            other.update(values)
        return other

    def __copy__(self) -> Scene:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        return (Scene, (self.toml, self.name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.keys())

    def __len__(self) -> int:
        return len(self._core.keys())

    def __contains__(self, key: object) -> bool:
        return key in self._core.keys()

    def keys(self) -> list[str]:
        """Return every key that has a meaning in this scene, with indices."""
        return self._core.keys()

    _ipython_key_completions_ = keys

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene) or self._draft is not None or other._draft is not None:
            return isinstance(other, Scene) and self._draft == other._draft
        return self.toml == other.toml

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        if self._draft is not None:
            return f"<aspic.Scene {self._draft[1]!r}: empty>"
        return f"<aspic.Scene {self.name!r}: {', '.join(self.bodies) or 'no bodies'}>"

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write the scene file. Raises FileExistsError unless ``overwrite``, and what ``open()`` raises."""
        with open(path, "w" if overwrite else "x", encoding="utf-8") as file:
            file.write(self.toml)

    def stable_timestep(self, thorough: bool = False) -> float | None:
        """Return the largest stable time step of the scene's integrator [s], springs linearized at rest.

        Infinite where nothing limits it (implicit Euler); None where some mode grows at any step (explicit Euler
        without damping). ``thorough``: seconds of work for a sharper bound; the true limit is this or larger.
        """
        return self._core.stable_step(thorough)[0]

    def view(self) -> Any:
        """Open the window at the scene's start, and return its process (``subprocess.Popen``) at once.

        Needs the program ``aspic`` with its window: in PATH, or named by the environment variable ASPIC_PROGRAM. Raises
        FileError where it is not found.
        """
        return _program.view(self.name, self.toml)


def load(name: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> Scene:
    """Read a built-in scene by its name, or else a scene file.

    ``overrides``: keys and values as ``Scene.update()`` takes them. Write ``./cube-plane`` for a file with a built-in's
    name. Raises SceneError with every mistake, its line and the nearest word; FileError for a path that cannot be read.
    """
    words = assignments(overrides)
    try:
        return Scene._of(*_aspic.Scene.load(os.fspath(name), words))
    except FileError as error:
        near = difflib.get_close_matches(os.fspath(name), [scene.name for scene in scenes()], 1)
        if not near:
            raise
        raise FileError(f"no scene or file is named {os.fspath(name)!r}; did you mean {near[0]!r}?") from error
