"""The names by which clients ask for memory: addresses of words, and bytes of the chip."""

from __future__ import annotations

import base64
import binascii
import re
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.dap.arguments import Arguments
from npchip.dap.session import Session
from npchip.debugger.language import parse_value
from npchip.debugger.values import Cell, Location, One, Pixel

Body = dict[str, Any]

_NP: Final = re.compile(r"np\((\d{1,6}),(\d{1,6})\)")
MOST_READ: Final = 1 << 20
"""Most bytes that a request may ask for."""


def address(number: int) -> str:
    """Return the reference of a word. One before the program is decimal."""
    return f"0x{number:03X}" if number >= 0 else str(number)


def rom(reference: str) -> int:
    """Return the address of a word by its reference.

    Raises:
        InputError: NP358, it is none.
    """
    try:
        return int(reference, 16 if reference.lower().startswith("0x") else 10)
    except ValueError:
        message = f"memoryReference {reference!r}: no address of an instruction"
        raise InputError("NP358", message) from None


class Bytes(NamedTuple):
    """Bytes that a client can read and write.

    Attributes:
        values: the bytes, uint8, of any shape.
        start: index of the first one that the reference names.
    """

    values: NDArray[np.uint8]
    start: int = 0


def _bytes(session: Session, reference: str) -> Bytes:
    """Return what a reference names.

    ``np(R,C)`` is the memory of an NP, ``np(R,C).mem[A]`` the same from a byte on, a register, flag
    or byte such as ``r3`` that of all NPs row by row, and ``pixels`` the exposed frame.
    """
    chip = session.debugger.chip
    if reference == "pixels":
        return Bytes(frame_of(session))
    text = f"{reference}.mem[0]" if _NP.fullmatch(reference) else reference
    value = parse_value(text, session.debugger.names)
    if isinstance(value, One) and value.cell.kind == "memory":
        return Bytes(chip.memory[:, value.row, value.column], int(value.cell.index))
    if isinstance(value, Cell):
        return Bytes(value.plane(chip).astype(np.uint8))
    raise InputError("NP358", f"memoryReference {reference!r} names no bytes")


def frame_of(session: Session) -> NDArray[np.uint8]:
    """Return the exposed frame, zeros before the first: uint8, shape (rows, columns)."""
    chip = session.debugger.chip
    if chip.frame is not None:
        return chip.frame
    return np.zeros((chip.machine.rows, chip.machine.cols), np.uint8)


def read(session: Session, arguments: Arguments) -> Body:
    """Read bytes. Those outside are not readable."""
    reference = arguments.text("memoryReference")
    offset, count = arguments.number("offset", 0), arguments.number("count", least=0)
    found = _bytes(session, reference)
    begin = found.start + offset
    flat = found.values.reshape(-1)
    if not 0 <= begin < flat.size:
        return {"address": str(begin), "unreadableBytes": count}
    data = flat[begin : begin + min(count, MOST_READ)].tobytes()
    body: Body = {"address": f"0x{begin:02X}", "data": base64.b64encode(data).decode()}
    return body | ({"unreadableBytes": count - len(data)} if len(data) < count else {})


def write(session: Session, arguments: Arguments) -> Body:
    """Write bytes by edits. Those that are already there are not written.

    Raises:
        InputError: NP352, NP358.
    """
    reference, offset = arguments.text("memoryReference"), arguments.number("offset", 0)
    try:
        data = base64.b64decode(arguments.text("data"), validate=True)
    except (binascii.Error, ValueError):
        raise InputError("NP358", "writeMemory: data: not base64") from None
    found = _bytes(session, reference)
    begin, flat = found.start + offset, found.values.reshape(-1).copy()
    room = max(0, flat.size - begin) if begin >= 0 else 0
    if len(data) > room and not arguments.flag("allowPartial"):
        message = f"{reference}: {len(data)} bytes from {begin} on do not fit in {flat.size}"
        raise InputError("NP352", message)
    written = data[:room]
    for index, value in enumerate(written, begin):
        if flat[index] != value:
            session.debugger.edit(_location(session, reference, index), value)
    return {"bytesWritten": len(written)}


def _location(session: Session, reference: str, index: int) -> Location:
    if reference == "pixels":
        return Pixel(*divmod(index, session.debugger.chip.machine.cols))
    text = f"{reference}.mem[0]" if _NP.fullmatch(reference) else reference
    value = parse_value(text, session.debugger.names)
    if isinstance(value, One):
        return One(Cell("memory", index), value.row, value.column)
    assert isinstance(value, Cell)
    return One(value, *divmod(index, session.debugger.chip.machine.np_cols))
