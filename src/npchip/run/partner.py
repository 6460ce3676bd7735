"""A finished run as the source of another chip's input bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from npchip.run.outputs import KINDS, output_of

if TYPE_CHECKING:
    from npchip.engines.base import Partner, Request
    from npchip.program.model import Program
    from npchip.run.result import RunResult


def sent_by(program: Program, result: RunResult, shape: tuple[int, int]) -> Partner:
    """Make a finished run the partner of another chip, frame for frame.

    Args:
        program: program of the run.
        result: the run; its first frame answers the first frame of the other chip.
        shape: NP rows and NP columns of both chips.

    Returns:
        A partner for `Chip.connect`.
    """

    def partner(request: Request) -> NDArray[np.uint8] | None:
        output = output_of(program, request.port)
        if output.name not in result.outputs or not 0 <= request.frame < result.frames:
            return None
        value = result.value(output.name, request.frame)
        sends = [] if value is None else [*KINDS[output.kind].sends(value)]
        if request.index >= len(sends):
            return None
        return np.full(shape, sends[request.index], np.uint8)

    return partner
