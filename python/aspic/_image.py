"""Images: arrays that notebooks show."""

from __future__ import annotations

import os
import struct
import zlib
from typing import Any

import numpy as np

__all__ = ["Image"]


class Image(np.ndarray):
    """An image: an array (height, width, 3) of uint8, RGB encoded as sRGB, rows from the top down.

    Notebooks show it; elsewhere it is an array like any other. A part of it is an image if its shape fits.
    """

    def _repr_png_(self) -> bytes | None:
        return self.png() if self._is_image() else None

    def _is_image(self) -> bool:
        return self.ndim == 3 and self.shape[2] == 3 and self.dtype == np.uint8 and self.size > 0

    def png(self) -> bytes:
        """Return the bytes of a PNG file. Raises ValueError for an array of another shape."""
        if not self._is_image():
            raise ValueError(f"an array {self.shape} of {self.dtype} is not an image: (height, width, 3) of uint8 is")
        height, width = self.shape[:2]
        # Each row differs little from the one above: filter 2, Up.
        rows = np.ascontiguousarray(self).reshape(height, 3 * width)
        differences = rows.copy()
        differences[1:] -= rows[:-1]
        filtered = np.full((height, 3 * width + 1), 2, dtype=np.uint8)
        filtered[:, 1:] = differences
        header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
        parts = ((b"IHDR", header), (b"IDAT", zlib.compress(filtered.tobytes(), 6)), (b"IEND", b""))
        return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in parts)

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write a PNG file. Raises FileExistsError unless ``overwrite``, and what ``open()`` raises."""
        data = self.png()
        with open(path, "wb" if overwrite else "xb") as file:
            file.write(data)

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        """Return results computed from an image as ordinary arrays or numbers."""
        plain = np.asarray(array)
        return plain if plain.ndim else plain[()]

    def __repr__(self) -> str:
        if self._is_image():
            return f"<aspic.{type(self).__name__}: {self.shape[1]} × {self.shape[0]}>"
        return super().__repr__()

    __str__ = __repr__


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
