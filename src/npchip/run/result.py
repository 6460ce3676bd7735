"""The result of a run: outputs and cycles of each frame, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

if TYPE_CHECKING:  # results are judged where there is no NumPy
    import numpy as np
    from numpy.typing import NDArray

    from npchip.program.model import Program

Status = Literal["halted", "frames-exhausted", "cycle-limit", "failed"]
"""The ways in which a run ends."""

Value: TypeAlias = "int | list[int] | NDArray[np.uint8] | None"
"""One output of one frame: scalar, list of scalars, plane or picture; None if nothing is sent."""


@dataclass(frozen=True)
class RunError:
    """The reason for which a run failed.

    Attributes:
        code: stable identifier such as ``"NP301"``.
        message: description; names the NP if one is to blame.
        address: program address of the instruction to blame, if there is one.
        file: source file of that instruction, if the program carries its source.
        line: 1-based line in `file`.
        processor: (row, column) of the NP to blame, if there is one.
    """

    code: str
    message: str
    address: int | None = None
    file: str | None = None
    line: int | None = None
    processor: tuple[int, int] | None = None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}: " if self.file else ""
        return f"{place}error: {self.message} [{self.code}]"


@dataclass(frozen=True)
class FrameRecord:
    """One frame, from an expose to the next; or the setup, from the start to the first expose.

    Attributes:
        cycles: cycles spent, the expose instruction included.
        instructions: instructions executed, the expose instruction included.
        outputs: value of every output by name; None if nothing was sent.
        complete: False if the cycle limit or a failure cut the frame short.
    """

    cycles: int
    instructions: int
    outputs: dict[str, Value]
    complete: bool = True

    def _repr_html_(self) -> str:
        from npchip.run.html import frame_html  # noqa: PLC0415 - notebooks only

        return frame_html(self)


class Measured(Protocol):
    """The facts about a run: a `RunResult`, or the same in plain lists.

    Attributes are those of `RunResult`; of `frame_cycles` and `frame_instructions` each element is
    an integer, and `outputs` holds the names.
    """

    @property
    def status(self) -> Status: ...  # noqa: D102 - as RunResult
    @property
    def error(self) -> RunError | None: ...  # noqa: D102
    @property
    def setup(self) -> FrameRecord: ...  # noqa: D102
    @property
    def first_frame(self) -> int: ...  # noqa: D102
    @property
    def frame_cycles(self) -> Any: ...  # noqa: D102
    @property
    def frame_instructions(self) -> Any: ...  # noqa: D102
    @property
    def outputs(self) -> Mapping[str, Any]: ...  # noqa: D102
    @property
    def cycles(self) -> int: ...  # noqa: D102
    @property
    def instructions(self) -> int: ...  # noqa: D102
    @property
    def frames(self) -> int: ...  # noqa: D102
    def value(self, name: str, frame: int) -> Any:
        """Return output `name` of frame `frame`; arrays may be lists of rows."""


@dataclass(frozen=True, eq=False, repr=False)
class RunResult:
    """The result of `Chip.run`. ``cycles == setup.cycles + frame_cycles.sum()`` always holds.

    Attributes:
        program: name of the program.
        engine: engine that ran it.
        machine: name of the machine description.
        status: end of the run.
        error: set exactly when `status` is ``"failed"``.
        setup: the part before the first expose of this run.
        first_frame: index of this run's first frame since the chip was reset.
        frame_cycles: int64, shape (T,): cycles of every frame.
        frame_instructions: int64, shape (T,): instructions of every frame.
        last_complete: False if the last frame was cut short.
        outputs: by name. ``scalar``/``scalar16``: int32, shape (T,). ``plane``: uint8, shape
            (T, NP rows, NP columns). ``picture``: uint8, shape (T, rows, columns). These are
            masked arrays if some frame sent nothing. ``list``: list of T lists (or None).
    """

    program: str
    engine: str
    machine: str
    status: Status
    error: RunError | None
    setup: FrameRecord
    first_frame: int
    frame_cycles: NDArray[np.int64]
    frame_instructions: NDArray[np.int64]
    last_complete: bool
    outputs: dict[str, Any]

    def __repr__(self) -> str:
        return (
            f"<RunResult of {self.program!r}: {self.status}, {self.frames} frames, "
            f"{self.cycles:,} cycles>"
        )

    @property
    def complete_cycles(self) -> NDArray[np.int64]:
        """Cycles of the complete frames: int64, shape (T,) or (T - 1,)."""
        return self.frame_cycles if self.last_complete else self.frame_cycles[:-1]

    @property
    def cycles(self) -> int:
        """Cycles of the whole run."""
        return self.setup.cycles + int(self.frame_cycles.sum())

    @property
    def instructions(self) -> int:
        """Instructions executed in the whole run."""
        return self.setup.instructions + int(self.frame_instructions.sum())

    @property
    def frames(self) -> int:
        """Number of frames taken, T."""
        return len(self.frame_cycles)

    def value(self, name: str, frame: int) -> Value:
        """Return output `name` of frame `frame`, 0-based in this run; None if nothing was sent."""
        import numpy as np  # noqa: PLC0415 - see the imports above

        column = self.outputs[name]
        if isinstance(column, list):
            return column[frame]  # type: ignore[no-any-return]
        missing = getattr(column, "mask", None)  # of a masked array; numpy.ma takes long to load
        if missing is not None and np.all(missing[frame]):
            return None
        cell = np.asarray(column)[frame]
        return int(cell) if cell.ndim == 0 else cell

    def _repr_html_(self) -> str:
        from npchip.run.html import result_html  # noqa: PLC0415 - notebooks only

        return result_html(self)


def over_budget(result: Measured, program: Program) -> RunError | None:
    """Return error NP320 if the worst frame takes more cycles than ``.budget cycles`` allows.

    Budgets hold for the default machine; the caller checks that it is the one.
    """
    budget, cycles = program.budget.cycles, list(result.frame_cycles)
    if budget is None or max(cycles, default=0) <= budget:
        return None
    worst = max(cycles)
    return RunError(
        "NP320",
        f"{program.name}: frame {result.first_frame + cycles.index(worst)} took {worst:,} cycles,"
        f" '.budget cycles' allows {budget:,}",
    )
