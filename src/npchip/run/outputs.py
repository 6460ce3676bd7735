"""What a program has sent in a frame, read as its ``.output`` lines say."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from npchip.engines.state import Send
from npchip.machine.layout import to_frames
from npchip.program.model import PORTS, Output, Program
from npchip.run.result import Value

PICTURE_SENDS = 64


class OutputError(Exception):
    """Sends that cannot be read as their ``.output`` line says.

    Attributes:
        code: NP310 NPs disagree, NP311 a wrong number of sends.
        address: address of the output instruction to blame; None where nothing was sent.
        processor: (row, column) of an NP to blame, if there is one.
    """

    def __init__(
        self,
        code: str,
        message: str,
        address: int | None = None,
        processor: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.address = address
        self.processor = processor


def read_outputs(program: Program, sends: Sequence[Send]) -> dict[str, Value]:
    """Outputs of one frame by name; ports without a name appear as ``port3`` planes.

    A port that got nothing reads None. For scalars and lists a send without an active NP is
    none (decision); for planes and pictures it is a send of zeros.

    Raises:
        OutputError: see there.
    """
    by_port: dict[int, list[Send]] = {}
    for send in sends:
        by_port.setdefault(send.port, []).append(send)
    values: dict[str, Value] = {
        output.name: _read(output, by_port.pop(output.port, [])) for output in program.outputs
    }
    for port in range(PORTS):
        if port in by_port:
            values[f"port{port}"] = by_port[port][-1].data
    return values


def nothing_sent(program: Program) -> dict[str, Value]:
    """The named outputs of a frame in which nothing can be read."""
    return dict.fromkeys((output.name for output in program.outputs), None)


def _read(output: Output, sends: list[Send]) -> Value:
    if output.kind == "picture":
        return _picture(output, sends)
    if output.kind == "plane":
        return sends[-1].data if sends else None
    heard = [send for send in sends if send.active is None or send.active.any()]
    if not heard:
        return None
    if output.kind == "list":
        return [_scalar(output, send) for send in heard]
    if output.kind == "scalar":
        return _scalar(output, heard[-1])
    if len(heard) != 2:
        raise OutputError(
            "NP311",
            f"output '{output.name}': a scalar16 is two sends, low byte first; found {len(heard)}",
            heard[-1].address,
        )
    low, high = (_scalar(output, send) for send in heard)
    return low | high << 8


def _scalar(output: Output, send: Send) -> int:
    active = np.ones(send.data.shape, np.bool_) if send.active is None else send.active
    first = _first(active)
    value = send.data[first]
    differs = active & (send.data != value)
    if differs.any():
        other = _first(differs)
        raise OutputError(
            "NP310",
            f"output '{output.name}' is a {output.kind}, but NP{_shown(first)} sent {value} and "
            f"NP{_shown(other)} sent {send.data[other]}",
            send.address,
            other,
        )
    return int(value)


def _picture(output: Output, sends: list[Send]) -> NDArray[np.uint8] | None:
    if not sends:
        return None
    if len(sends) != PICTURE_SENDS:
        raise OutputError(
            "NP311",
            f"output '{output.name}': a picture is exactly {PICTURE_SENDS} sends, one for each "
            f"pixel of an NP; found {len(sends)}",
            sends[-1].address,
        )
    return to_frames(np.stack([send.data for send in sends]))


def _first(where: NDArray[np.bool_]) -> tuple[int, int]:
    row, column = np.unravel_index(int(where.argmax()), where.shape)
    return int(row), int(column)


def _shown(processor: tuple[int, int]) -> str:
    return f"({processor[0]},{processor[1]})"
