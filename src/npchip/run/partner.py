"""What a chip has sent, for the input instructions of its partner."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from npchip.machine.layout import to_planes

if TYPE_CHECKING:
    from npchip.engines.base import Partner, Request
    from npchip.program.model import OutputKind, Program
    from npchip.run.result import RunResult, Value

SCALARS = ("scalar", "scalar16", "list")
"""Kinds of outputs that are the same in all NPs: a link carries them once, not once for each NP."""


def kind_of(program: Program, port: int) -> OutputKind:
    """Return what a program sends to a port; a port without a name is a plane."""
    return next((output.kind for output in program.outputs if output.port == port), "plane")


def sent_by(program: Program, result: RunResult, shape: tuple[int, int]) -> Partner:
    """Make a finished run the partner of another chip, frame for frame.

    Args:
        program: what the run executed.
        result: the run; its first frame is that of the other chip's first frame.
        shape: NP rows and NP columns of both chips.

    Returns:
        what `Chip.connect` takes.
    """
    names = {output.port: output.name for output in program.outputs}

    def partner(request: Request) -> NDArray[np.uint8] | None:
        name = names.get(request.port, f"port{request.port}")
        if name not in result.outputs or not 0 <= request.frame < result.frames:
            return None
        value = result.value(name, request.frame)
        planes = _planes(kind_of(program, request.port), value, shape)
        return planes[request.index] if request.index < len(planes) else None

    return partner


def _planes(kind: OutputKind, value: Value, shape: tuple[int, int]) -> list[NDArray[np.uint8]]:
    """Return what all NPs sent, a plane for each execution of the output instruction."""
    if value is None:
        return []
    if isinstance(value, np.ndarray):
        return [value] if kind == "plane" else [*to_planes(value)]
    if isinstance(value, list):
        numbers = value
    else:
        numbers = [value & 0xFF, value >> 8] if kind == "scalar16" else [value]
    return [np.full(shape, number, np.uint8) for number in numbers]
