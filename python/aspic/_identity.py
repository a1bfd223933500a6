"""Identity of a function, the same in every process."""

from __future__ import annotations

import functools
import inspect
import marshal
import os
import pickle
import sysconfig
import types
from typing import Any

__all__ = ["identity"]


def identity(value: Any) -> bytes:
    """Return bytes that differ for functions that compute something else.

    Its code, defaults, closure and the globals that it reads; of a bound method and a callable object also their state;
    of a ``functools.partial`` its arguments. Raises what ``pickle.dumps()`` raises for values that it cannot take.
    """
    return _Identity().of(value)


class _Identity:
    def __init__(self) -> None:
        self._seen: set[int] = set()

    def of(self, value: Any) -> bytes:
        return repr(self._parts(value)).encode()

    def _parts(self, value: Any) -> Any:
        if isinstance(value, types.ModuleType):
            return ("module", value.__name__)
        if isinstance(value, functools.partial):
            return ("partial", self._parts(value.func), self._all(value.args), self._all(value.keywords))
        if isinstance(value, types.MethodType):
            return ("method", self._parts(value.__func__), self._parts(value.__self__))
        if isinstance(value, types.FunctionType):
            return self._function(value)
        if isinstance(value, type):
            return self._class(value)
        if isinstance(value, (list, tuple, dict)):
            return (type(value).__name__, self._all(value))
        if callable(value) and not isinstance(value, types.BuiltinFunctionType) and hasattr(value, "__dict__"):
            return ("object", self._class(type(value)), self._all(vars(value)))
        return ("value", pickle.dumps(value, protocol=4))

    def _all(self, values: Any) -> Any:
        if isinstance(values, dict):
            return [(self._parts(key), self._parts(item)) for key, item in values.items()]
        return [self._parts(item) for item in values]

    def _function(self, function: types.FunctionType) -> Any:
        name = f"{function.__module__}.{function.__qualname__}"
        if id(function) in self._seen or _installed(function):
            return ("named", name)
        self._seen.add(id(function))
        code = function.__code__
        read = [function.__globals__[n] for n in sorted(_names(code)) if n in function.__globals__]
        cells = [cell.cell_contents for cell in function.__closure__ or ()]
        more = (function.__defaults__, function.__kwdefaults__)
        return ("function", _code(code), self._all(cells), self._all(more), self._all(read))

    def _class(self, kind: type) -> Any:
        name = f"{kind.__module__}.{kind.__qualname__}"
        if id(kind) in self._seen:
            return ("named", name)
        self._seen.add(id(kind))
        try:
            return ("class", name, inspect.getsource(kind))
        except (OSError, TypeError):  # built in, or typed into an interpreter
            methods = {n: f for n, f in vars(kind).items() if isinstance(f, types.FunctionType)}
            return ("class", name, self._all(methods))


def _installed(function: types.FunctionType) -> bool:
    """Return whether a module belongs to Python or a package, whose version identifies it."""
    places = {sysconfig.get_path(name) for name in ("stdlib", "purelib", "platlib")}
    file = function.__code__.co_filename
    return any(place is not None and file.startswith(place + os.sep) for place in places)


def _code(code: types.CodeType) -> Any:
    """Return the source text, which is the same in all versions of Python, or the byte code if there is no source."""
    try:
        return inspect.getsource(code)
    except (OSError, TypeError):
        return marshal.dumps(code)


def _names(code: types.CodeType) -> set[str]:
    """Return the globals and attributes that the code reads, nested functions included."""
    inner = (_names(part) for part in code.co_consts if isinstance(part, types.CodeType))
    return set(code.co_names).union(*inner)
