"""Pictures of the chip, the adapter's own request ``npchip/picture``."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.suggest import suggestion
from npchip.dap.arguments import Arguments
from npchip.dap.memory import frame_of
from npchip.dap.session import Session
from npchip.debugger.values import Cell
from npchip.machine.layout import to_frames
from npchip.run.outputs import output_of

Body = dict[str, Any]


def picture(session: Session, arguments: Arguments) -> Body:
    """Return a plane or a picture: rows, columns, type, and the bytes row by row as base64.

    ``what`` is ``pixels`` (the exposed frame), a register, a flag, ``active`` or ``mem[A]`` (a
    value of each NP), ``bank A`` (64 bytes of each NP as pixels), or ``output NAME`` or ``port N``
    (what this frame has sent so far: a number is a byte, a scalar16 two with the low one first).

    Raises:
        NpchipError: NP350, NP351, NP358, it names nothing of the kind.
    """
    what = arguments.text("what")
    found = _picture(session, what)
    rows, columns = found.shape
    return {
        "what": what,
        "rows": rows,
        "cols": columns,
        "dtype": "bool" if found.dtype == np.bool_ else "uint8",
        "data": base64.b64encode(found.tobytes()).decode(),
        "frame": session.debugger.chip.frames_taken - 1,
    }


def _picture(session: Session, what: str) -> NDArray[Any]:
    chip = session.debugger.chip
    first, _, rest = what.strip().partition(" ")
    if what.strip() == "pixels":
        return frame_of(session)
    if first in {"output", "port"} and rest:
        return _sent(session, first, rest.strip())
    shown = session.commands.picture(what)
    if shown is None:
        return frame_of(session)
    if isinstance(shown, Cell):
        return shown.plane(chip)
    return to_frames(chip.memory[shown : shown + 64])


def _sent(session: Session, kind: str, name: str) -> NDArray[np.uint8]:
    program, outputs = session.debugger.program, session.debugger.outputs
    if kind == "port":
        if not (name.isascii() and name.isdecimal() and len(name) < 4):
            raise InputError("NP358", f"port {name}: expected a number")
        name = output_of(program, int(name)).name
    if name not in outputs:
        hint = suggestion(name, outputs) or f"outputs: {', '.join(outputs) or 'none'}"
        raise InputError("NP351", f"nothing is sent as {name}", hint=hint)
    value = outputs[name]
    if isinstance(value, np.ndarray):
        return value
    if value is None:
        return np.zeros((0, 0), np.uint8)
    if isinstance(value, int):
        wide = any(item.name == name and item.kind == "scalar16" for item in program.outputs)
        value = [value & 0xFF, value >> 8] if wide else [value]
    return np.array([value], np.uint8)
