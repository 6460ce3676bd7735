"""Bytes for the NPs' memory, from files (``--memory``, ``memory=``) and ``.memory`` lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import open_input
from npchip.frames.npy import Header, read_header
from npchip.machine import Machine

if TYPE_CHECKING:
    from npchip.program.model import Initial, Program

Planes = tuple[int, NDArray[np.uint8]]
"""An address of the NPs' memory, and uint8 of shape (n, NP rows, NP columns) for the bytes from it
on."""
Memory = Sequence[Planes]


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


def initial_memory(program: Program, machine: Machine, given: Memory = ()) -> list[Planes]:
    """Return what the NPs' memory holds before a run of a program, in the order of writing.

    Args:
        program: the program, with its ``.memory`` lines.
        machine: where it runs.
        given: more of the kind; where one has the address of a ``.memory`` line, the line's own
            file is not read.

    Raises:
        InputError: NP243, the file of a line cannot be read, or does not fit.
    """
    replaced = {address for address, _ in given}
    lines = [item for item in program.memory if item.address not in replaced]
    return [*((item.address, _planes(item, machine)) for item in lines), *given]


def with_bytes(program: Program, machine: Machine) -> Program:
    """Return the program with the bytes of its ``.memory`` lines instead of the files' names.

    Raises:
        InputError: as `initial_memory`.
    """
    memory = tuple(
        item._replace(file="", planes=tuple(plane.tobytes() for plane in _planes(item, machine)))
        for item in program.memory
    )
    return replace(program, memory=memory)


def _planes(item: Initial, machine: Machine) -> NDArray[np.uint8]:
    if item.planes is not None:
        planes = np.frombuffer(b"".join(item.planes), np.uint8)
        if planes.size != len(item.planes) * machine.np_rows * machine.np_cols:
            message = f"{item.place}: these bytes are for an array of another size"
            raise InputError("NP243", message, hint="assemble the source for this machine")
        return planes.reshape(len(item.planes), *machine.geometry)
    try:
        return read_memory(item.address, Path(item.file), machine)
    except InputError as error:
        hint = error.hint or f"--memory {item.address}=FILE.npy takes another file"
        raise InputError(error.code, f"{item.place}: {error.message}", hint=hint) from None


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
