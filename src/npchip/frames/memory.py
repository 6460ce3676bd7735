"""Files with bytes for the NPs' memory (``--memory``, ``memory=``)."""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import open_input
from npchip.frames.npy import Header, read_header
from npchip.machine import Machine


def read_memory(address: int, path: Path, machine: Machine) -> NDArray[np.uint8]:
    """Read bytes for the NPs' memory from `address` on.

    Returns:
        uint8, shape (n, NP rows, NP columns).

    Raises:
        InputError: NP243, the file cannot be read, or its shape, type or values do not fit.
    """
    try:
        with open_input(path) as file:
            shape, fortran, dtype = _header(file, path)
            start = file.tell()
            _check(shape, dtype, address, path, machine)
            size = int(np.prod(shape, dtype=np.int64)) * dtype.itemsize
            held = file.seek(0, 2) - start
            if held != size:
                message = f"{path}: {dtype} {shape} takes {size} bytes, the file holds {held}"
                raise InputError("NP243", message)
            file.seek(start)
            array = np.frombuffer(file.read(size), dtype)
    except OSError as error:
        raise InputError("NP243", f"cannot read {path}: {error.strerror or error}") from None
    if array.size and not 0 <= array.min() <= array.max() <= 255:
        raise _values(dtype, path)
    return array.astype(np.uint8).reshape(shape, order="F" if fortran else "C")


def _header(file: BinaryIO, path: Path) -> Header:
    try:
        return read_header(file)
    except ValueError:
        file.seek(0)
        zipped = file.read(2) == b"PK"
        kind = "an archive of arrays (.npz)" if zipped else "not a NumPy array file"
        raise InputError("NP243", f"{path}: {kind}, expected one .npy array") from None


def _check(
    shape: tuple[int, ...], dtype: np.dtype[Any], address: int, path: Path, machine: Machine
) -> None:
    space = machine.memory_bytes - address
    if len(shape) != 3 or shape[1:] != machine.geometry or not 0 <= shape[0] <= space:
        raise InputError(
            "NP243",
            f"{path}: the array's shape is {shape}, expected"
            f" (n, {machine.np_rows}, {machine.np_cols}) with n up to {max(space, 0)},"
            f" as NP memory has {machine.memory_bytes} bytes and the first goes to {address}",
        )
    if dtype.kind not in "ui":
        raise _values(dtype, path)


def _values(dtype: np.dtype[Any], path: Path) -> InputError:
    return InputError(
        "NP243",
        f"{path}: values are {dtype}, expected whole numbers from 0 to 255",
        hint="convert with array.clip(0, 255).round().astype('uint8')",
    )
