"""The program aspic, for its window."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from ._errors import FileError

if TYPE_CHECKING:
    import subprocess


def find() -> str:
    """Return the path of the program. Raises FileError if it is missing."""
    import shutil

    named = os.environ.get("ASPIC_PROGRAM")
    found = shutil.which(named or "aspic")
    if found:
        return found
    if named:
        raise FileError(f"ASPIC_PROGRAM is {named!r}, which is not a program: set it to that of Aspic, or unset it.")
    raise FileError(
        "the window is part of the program aspic, which is not in PATH: build it (scripts/run.sh) and put it there, or "
        "name it in the environment variable ASPIC_PROGRAM. Simulation.render() needs no window."
    )


def view(name: str, toml: str) -> subprocess.Popen[bytes]:
    """Open the window with a scene. Raises FileError if the program is missing."""
    import shutil
    import subprocess
    import tempfile
    import threading

    program = find()
    folder = tempfile.mkdtemp(prefix="aspic-")
    # The window's title is the name of the file where the scene has none.
    path = os.path.join(folder, "".join(c if c.isalnum() or c in "-_." else "-" for c in name) + ".toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(toml)
    process = subprocess.Popen([program, "view", path], stdin=subprocess.DEVNULL)

    def remove() -> None:
        process.wait()
        shutil.rmtree(folder, ignore_errors=True)

    threading.Thread(target=remove, daemon=True).start()
    return process
