"""What all tests of the package share. They test the package that Python finds: in the build folder, or installed."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import signal
import subprocess
import zlib
from collections.abc import Callable, Iterator
from typing import Any

import aspic
import numpy as np
import pytest

root = pathlib.Path(__file__).resolve().parents[2]
backends = ("reference", "cpu", "gpu")
# A shell has what it starts in the background ignore Ctrl-C, and Python leaves it at that.
signal.signal(signal.SIGINT, signal.default_int_handler)
small: dict[str, Any] = {"cube[0].particles-per-edge": 4, "cube[0].position": [0, 2.2, 0]}


@pytest.fixture(autouse=True)
def own_folder(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    yield


@pytest.fixture
def scene() -> aspic.Scene:
    """A cube of 64 particles that is about to land on a plane."""
    return aspic.load("cube-plane", small)


def simulation(scene: aspic.Scene | str, backend: str, **options: Any) -> aspic.Simulation:
    """One on a backend; without a device the test is skipped, except where ASPIC_NEED_GPU is set."""
    try:
        return aspic.Simulation(scene, backend, **options)
    except aspic.DeviceError as error:
        if os.environ.get("ASPIC_NEED_GPU"):
            raise
        pytest.skip(f"no device: {error}")


def needs_images() -> None:
    simulation(aspic.load("cube-plane", small), "gpu")


@pytest.fixture(params=backends)
def sim(request: pytest.FixtureRequest, scene: aspic.Scene) -> aspic.Simulation:
    """The small cube on each backend."""
    return simulation(scene, request.param)


@pytest.fixture
def program() -> Callable[..., dict[str, Any]]:
    """Runs the program aspic and returns its JSON."""
    path = os.environ.get("ASPIC_PROGRAM") or shutil.which("aspic")
    if not path:
        pytest.skip("the program aspic is neither in PATH nor in ASPIC_PROGRAM")

    def run(*arguments: str) -> dict[str, Any]:
        done = subprocess.run([path, *arguments, "--json"], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)  # type: ignore[no-any-return]

    return run


def set_arguments(values: dict[str, Any]) -> list[str]:
    """Values of a scene as the program takes them."""
    words: list[str] = []
    for key, value in values.items():
        words += ["--set", f"{key}={json.dumps(value)}"]
    return words


def read_png(data: bytes) -> Any:
    """The pixels of a PNG of 8-bit RGB, (height, width, 3)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        length, name = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + length]
        assert int.from_bytes(data[at + 8 + length : at + 12 + length], "big") == zlib.crc32(name + body)
        if name == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
            assert body[8:] == b"\x08\x02\x00\x00\x00"
        packed += body if name == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, 1 + 3 * width)
    pixels = np.zeros((height + 1, width + 1, 3), dtype=np.int64)  # with a row above and a column to the left
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].reshape(width, 3).astype(np.int64)
        for x in range(width):
            left, up, corner = pixels[y + 1, x], pixels[y, x + 1], pixels[y, x]
            if kind == 4:
                p = left + up - corner
                away = np.abs([p - left, p - up, p - corner])
                best = np.where(
                    (away[0] <= away[1]) & (away[0] <= away[2]), left, np.where(away[1] <= away[2], up, corner)
                )
            else:
                best = [0, left, up, (left + up) // 2][kind]
            pixels[y + 1, x + 1] = (row[x] + best) % 256
    return pixels[1:, 1:].astype(np.uint8)
