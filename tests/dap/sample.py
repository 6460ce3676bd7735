"""A small program that has what a debugger can stop at, and what it is launched with."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

SOURCE = """\
.output count, 0, scalar
.output plane, 1, plane
.equ    STEP, 1
.reg    value, r3
.macro  double, rx
        ADD     rx, rx
.endm
        MOV     r0, #0
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      value, [5]
        CALL    more
        double  value
        ST      [70], value
        OUT     0, r0
        OUT     1, value
        JMP     frame

more:   ADD     r0, #STEP
        ROW     r1
        RET
"""
START, FRAME, LOAD, CALL, DOUBLE, STORE, SEND, MORE, LAST = 8, 9, 11, 12, 13, 14, 15, 19, 21
"""Lines of the source."""
INSIDE = 6
"""The line of the macro."""
FRAMES = 6
BIG = "extends: default\ngeometry: {np_rows: 128, np_cols: 160}\n"


class Sample(NamedTuple):
    """The files of the program.

    Attributes:
        source: the program.
        clip: frame k has the value 10 k.
        big: a machine of 20,480 NPs.
    """

    source: Path
    clip: Path
    big: Path

    def launch(self, **more: Any) -> dict[str, Any]:
        """Return the arguments of a launch that stops on entry."""
        launch = {"program": str(self.source), "frames": str(self.clip), "stopOnEntry": True}
        return launch | more

    def lines(self, *lines: int | dict[str, Any]) -> dict[str, Any]:
        """Return the arguments that set breakpoints on lines."""
        items = [{"line": line} if isinstance(line, int) else line for line in lines]
        return {"source": {"path": str(self.source)}, "breakpoints": items}


def write(folder: Path) -> Sample:
    """Write the files."""
    sample = Sample(folder / "sample.s", folder / "clip.npy", folder / "big.yaml")
    sample.source.write_text(SOURCE, encoding="utf-8")
    sample.big.write_text(BIG, encoding="utf-8")
    levels = np.arange(FRAMES, dtype=np.uint8)[:, None, None] * 10
    np.save(sample.clip, np.broadcast_to(levels, (FRAMES, 64, 80)).astype(np.uint8))
    return sample
