"""Headers and values of `.npy` files, read in constant memory."""

from __future__ import annotations

import io
import warnings
from typing import Any, BinaryIO

import numpy as np

_HEADER = 1 << 16
"""Bytes that hold any header; one may claim to be longer."""
_AT_ONCE = 1 << 22

_READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
    (3, 0): np.lib.format.read_array_header_2_0,  # it differs in names of fields only
}

Header = tuple[tuple[int, ...], bool, np.dtype[Any]]
"""Shape, order (true for Fortran's) and type."""


def read_header(file: BinaryIO) -> Header:
    """Read the header of a `.npy` file, which is left where its values begin.

    Raises:
        ValueError: it cannot be read.
    """
    start = io.BytesIO(file.read(_HEADER))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            version = np.lib.format.read_magic(start)
            read = _READERS.get(version)
            header = read and read(start)
        except Exception as error:  # noqa: BLE001 - a header is an expression to be parsed
            said = (str(error).splitlines() or [type(error).__name__])[0]
            raise ValueError(said[:200]) from None
    if header is None:
        raise ValueError(f"a .npy file of version {version[0]}.{version[1]}")
    shape = header[0]
    if any(length < 0 for length in shape):
        raise ValueError(f"its header says shape {shape}")
    file.seek(start.tell())
    return header


def value_range(file: BinaryIO, dtype: np.dtype[Any], size: int) -> tuple[int, int]:
    """Return the least and the greatest of the integers in the next `size` bytes of a file."""
    low = high = None
    while size > 0 and (data := file.read(min(size, _AT_ONCE))):
        values = np.frombuffer(data, dtype)
        size -= len(data)
        low = int(values.min()) if low is None else min(low, int(values.min()))
        high = int(values.max()) if high is None else max(high, int(values.max()))
    return low or 0, high or 0
