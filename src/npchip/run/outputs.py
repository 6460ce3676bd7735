"""The kinds of outputs, and reading sends as a program's ``.output`` lines say.

`Kind` is the base class of all kinds, `KINDS` the list of them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Fault
from npchip.engines.batch import Folded, Send, SendLog
from npchip.machine.layout import to_frames, to_planes
from npchip.machine.model import PIXELS
from npchip.program.model import OUTPUT_FORMS, Form, Output, OutputKind, Program
from npchip.run.result import Value

_PICTURE_SENDS = PIXELS * PIXELS


class OutputError(Fault):
    """Sends that do not fit their ``.output`` line.

    The code is NP310 if NPs disagree, NP311 for a wrong number of sends.
    """


class Column(NamedTuple):
    """One output of the frames of a batch.

    Attributes:
        present: bool, shape (n,): False if nothing was sent; None if all frames have a value.
        values: values of the m frames that have one, in order: integers (m,), m lists of
            integers, or uint8 (m, rows, columns), as the kind's `form` says.
    """

    present: NDArray[np.bool_] | None
    values: Any

    def frame(self, number: int) -> Value:
        """Return the value of one frame; None if nothing was sent."""
        if self.present is not None:
            if not self.present[number]:
                return None
            number = int(np.count_nonzero(self.present[:number]))
        value = self.values[number]
        if isinstance(value, list):
            return value
        return value.copy() if np.ndim(value) else int(value)


@dataclass(frozen=True, eq=False)
class _Sends:
    """Sends of a batch to one port.

    Attributes:
        log: all sends of the batch.
        numbers: their indices in the log: int64, shape (n,).
        frames: their frames: int64, shape (n,), in ascending order.
    """

    log: SendLog
    numbers: NDArray[np.int64]
    frames: NDArray[np.int64]

    @classmethod
    def to_port(cls, log: SendLog, port: int) -> _Sends:
        numbers = np.flatnonzero(log.port == port)
        return cls(log, numbers, log.frame[numbers])

    def some(self, which: NDArray[np.bool_]) -> _Sends:
        return _Sends(self.log, self.numbers[which], self.frames[which])

    def last(self) -> _Sends:
        """Return the last send of each frame."""
        return self.some(np.diff(self.frames, append=-1) != 0)

    def heard(self) -> _Sends:
        """Return the sends with an active NP."""
        if not len(self._masked) or self._folded.heard.all():
            return self
        kept = np.ones(len(self.numbers), np.bool_)
        kept[self._masked] = self._folded.heard
        return self.some(kept)

    def counts(self) -> NDArray[np.int64]:
        """Return the number of sends in each frame: int64, shape (frames,)."""
        return np.bincount(self.frames, minlength=len(self.log.ends))

    def exactly(self, wanted: int, output: Output, rule: str) -> _Sends:
        """Return the sends; raise OutputError if a frame has some, but not as many as wanted."""
        counts = self.counts()
        wrong = np.flatnonzero((counts != 0) & (counts != wanted))
        if len(wrong):
            raise OutputError(
                "NP311",
                f"output '{output.name}': a {output.kind} is {rule}; found {counts[wrong[0]]}",
                self._address(int(counts[: wrong[0] + 1].sum()) - 1),
            )
        return self

    def agreed(self, output: Output) -> NDArray[np.uint8]:
        """Return the byte of the active NPs for each send: uint8, shape (n,).

        Raises:
            OutputError: active NPs disagree.
        """
        values = self.log.value[self.numbers]
        everywhere = np.flatnonzero(self._planes == 1)
        broken: list[int] = []
        for sends, folded in (
            (everywhere, self._fold(everywhere, masked=False)),
            (self._masked, self._folded),
        ):
            values[sends] = folded.byte
            broken += sends[~folded.agreed][:1].tolist()
        if broken:
            raise self._disagreement(output, min(broken))
        return values

    def _disagreement(self, output: Output, send: int) -> OutputError:
        """Return the error of a send whose active NPs have different bytes."""
        (data,), (active,) = (
            of(self.numbers[[send]]) for of in (self.log.bytes_of, self.log.active_of)
        )
        first = int(active.argmax())
        other = int((active & (data != data[first])).argmax())
        here, there = self._processor(first), self._processor(other)
        return OutputError(
            "NP310",
            f"output '{output.name}' is a {output.kind}, but NP{_shown(here)} sent "
            f"{data[first]} and NP{_shown(there)} sent {data[other]}",
            self._address(send),
            there,
        )

    def bytes(self) -> NDArray[np.uint8]:
        """Return all bytes, 0 for inactive NPs: uint8, shape (n, NP rows, NP columns)."""
        return self.log.bytes_of(self.numbers).reshape(-1, *self.log.shape)

    def column(self, values: Any) -> Column:
        """Return a column with the values of all frames that have sends."""
        present = np.zeros(len(self.log.ends), np.bool_)
        present[self.frames] = True
        return Column(present, values)

    @cached_property
    def _planes(self) -> NDArray[np.int64]:
        planes: NDArray[np.int64] = self.log.sites.planes[self.log.site[self.numbers]]
        return planes

    @cached_property
    def _masked(self) -> NDArray[np.int64]:
        """Indices of the sends in masked regions."""
        return np.flatnonzero(self._planes == 2)

    @cached_property
    def _folded(self) -> Folded:
        """The single bytes of the sends in masked regions."""
        return self._fold(self._masked, masked=True)

    def _fold(self, sends: NDArray[np.int64], *, masked: bool) -> Folded:
        return self.log.folded(self.log.first_plane[self.numbers[sends]], masked=masked)

    def _address(self, index: int) -> int:
        return int(self.log.sites.address[self.log.site[self.numbers[index]]])

    def _processor(self, number: int) -> tuple[int, int]:
        return divmod(number, self.log.shape[1])


def _shown(processor: tuple[int, int]) -> str:
    return f"({processor[0]},{processor[1]})"


class Kind(ABC):
    """One kind of output.

    Attributes:
        name: as in the ``.output`` line.
        side: rows and columns of an NP's part of an array.
    """

    name: ClassVar[OutputKind]
    side: ClassVar[int] = 1

    @property
    def form(self) -> Form:
        """Type of a frame's value."""
        return OUTPUT_FORMS[self.name]

    @abstractmethod
    def read(self, output: Output, log: SendLog) -> Column:
        """Read an output of this kind in all frames of a batch.

        Integers and lists ignore a send without an active NP (decision); arrays take it as a send
        of zeros.

        Raises:
            OutputError: the sends of a frame are not a value of this kind.
        """

    @abstractmethod
    def sends(self, value: Any) -> Iterable[int | NDArray[np.uint8]]:
        """Return the sends of a value: for each send one byte for all NPs, or a byte of each NP."""


class _Scalar(Kind):
    """The last byte."""

    name = "scalar"

    def read(self, output: Output, log: SendLog) -> Column:
        values = log.by_frame(output.port)
        if values is not None:
            return Column(None, values[:, -1])
        sends = _Sends.to_port(log, output.port).heard().last()
        return sends.column(sends.agreed(output))

    def sends(self, value: int) -> Iterable[int]:
        return [value]


class _Scalar16(Kind):
    """Two bytes, the low one first."""

    name = "scalar16"

    def read(self, output: Output, log: SendLog) -> Column:
        values = log.by_frame(output.port)
        if values is not None and values.shape[1] == 2:
            low, high = values.astype(np.int32).T
            return Column(None, low | high << 8)
        sends = _Sends.to_port(log, output.port).heard()
        sends = sends.exactly(2, output, "two sends, low byte first")
        low, high = sends.agreed(output).reshape(-1, 2).astype(np.int32).T
        return sends.column(low | high << 8)

    def sends(self, value: int) -> Iterable[int]:
        return [value & 0xFF, value >> 8]


class _List(Kind):
    """All bytes."""

    name = "list"

    def read(self, output: Output, log: SendLog) -> Column:
        rows = log.by_frame(output.port)
        if rows is not None:
            return Column(None, rows.tolist())
        sends = _Sends.to_port(log, output.port).heard()
        values, counts = sends.agreed(output).tolist(), sends.counts()
        ends = np.cumsum(counts[counts > 0]).tolist()
        return sends.column([values[a:b] for a, b in zip([0, *ends], ends, strict=False)])

    def sends(self, value: list[int]) -> Iterable[int]:
        return value


class _Plane(Kind):
    """A byte of each NP: the last send."""

    name = "plane"

    def read(self, output: Output, log: SendLog) -> Column:
        sends = _Sends.to_port(log, output.port).last()
        return sends.column(sends.bytes())

    def sends(self, value: NDArray[np.uint8]) -> Iterable[NDArray[np.uint8]]:
        return [value]


class _Picture(Kind):
    """All pixels: a send for each pixel of an NP."""

    name = "picture"
    side = PIXELS

    def read(self, output: Output, log: SendLog) -> Column:
        sends = _Sends.to_port(log, output.port)
        rule = f"exactly {_PICTURE_SENDS} sends, one for each pixel of an NP"
        planes = sends.exactly(_PICTURE_SENDS, output, rule).bytes()
        return sends.column(to_frames(planes.reshape(-1, _PICTURE_SENDS, *log.shape)))

    def sends(self, value: NDArray[np.uint8]) -> Iterable[NDArray[np.uint8]]:
        return to_planes(value)


KINDS: dict[OutputKind, Kind] = {
    kind.name: kind for kind in (_Scalar(), _Scalar16(), _List(), _Plane(), _Picture())
}
"""All kinds of outputs by name."""


def output_of(program: Program, port: int) -> Output:
    """Return the declared output of a port; an undeclared port is a plane such as ``port3``.

    Should that be the name of a declared output, it is ``port3_``.
    """
    name, taken = f"port{port}", {output.name for output in program.outputs}
    while name in taken:
        name += "_"
    unnamed = Output(name, port, "plane")
    return next((output for output in program.outputs if output.port == port), unnamed)


def read_outputs(program: Program, log: SendLog) -> dict[str, Column]:
    """Read the outputs of all frames of a batch.

    Returns:
        The declared outputs by name, then the undeclared ports that were used; none at all if
        nothing was sent.

    Raises:
        OutputError: the outputs of some frame cannot be read; the message is exact for a batch of
            one frame.
    """
    if not (len(log.site) or log.arrays):
        return {}
    outputs = [*program.outputs]
    named = {output.port for output in outputs}
    unnamed = sorted({*log.sites.port.tolist()} - named)
    used = (port for port in unnamed if port in log.arrays or (log.port == port).any())
    outputs += [output_of(program, port) for port in used]
    return {
        output.name: Column(None, log.arrays[output.port])
        if output.port in log.arrays
        else KINDS[output.kind].read(output, log)
        for output in outputs
    }


def read_frame(program: Program, sends: Sequence[Send]) -> dict[str, Value]:
    """Read the outputs of one frame, None without a send; errors as `read_outputs`."""
    if not sends:
        return nothing_sent(program)
    columns = read_outputs(program, SendLog.of(sends, sends[0].data.shape))
    return {name: column.frame(0) for name, column in columns.items()}


def nothing_sent(program: Program) -> dict[str, Value]:
    """Return the declared outputs of a frame that sent nothing."""
    return dict.fromkeys((output.name for output in program.outputs), None)
