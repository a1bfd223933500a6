"""Refuses sub-interpreters, in which the extension module would break the main one."""

from __future__ import annotations

import importlib
import sys
from typing import Any

_NAME = "_interpreters" if sys.version_info >= (3, 13) else "_xxsubinterpreters"


def _is_main() -> bool:
    known = _NAME in sys.modules
    try:
        interpreters: Any = importlib.import_module(_NAME)
    except ImportError:
        return True  # without the module Python makes no others
    if not known:
        del sys.modules[_NAME]
    current, main = interpreters.get_current(), interpreters.get_main()
    return bool(current == main)


if not _is_main():
    raise ImportError("aspic works in the main interpreter alone: use threads or processes instead of sub-interpreters")
