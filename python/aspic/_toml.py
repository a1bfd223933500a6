"""Values of Python as the library takes them: TOML."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from typing import Any

from ._errors import SceneError, UsageError

__all__ = ["assignments", "toml_of"]


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _toml_key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _quoted(key)


def toml_of(value: Any) -> str:
    """Return a value as TOML. Arrays and numbers of numpy become lists and numbers."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_toml_key(str(key))} = {toml_of(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_of(item) for item in value) + "]"
    if isinstance(value, os.PathLike):
        return _quoted(os.fspath(value))
    raise UsageError(f"a value of a scene is a number, a word, a list or a dict of them, not {type(value).__name__}")


def assignments(values: Mapping[str, Any] | None) -> list[str]:
    """Return keys and values as arguments of --set."""
    found = []
    for key, value in (values or {}).items():
        if not isinstance(key, str) or "=" in key:
            raise SceneError(f"a key of a scene is a path such as 'cube[0].edge-length', not {key!r}")
        found.append(f"{key}={toml_of(value)}")
    return found
