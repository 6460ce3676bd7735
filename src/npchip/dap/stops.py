"""Reasons for which the program stops, in the protocol's words."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from npchip.base.errors import NpchipError
from npchip.dap.points import Hit
from npchip.debugger.conditions import Stop

FILTERS: Final = {
    "trap": ("Traps", "an instruction that cannot be executed"),
    "cycle-limit": ("Frames without an end", "a frame that takes more cycles than maxCycles"),
    "outputs": ("Unreadable outputs", "outputs that are not what the .output lines say"),
    "end": ("End of the run", "stop at the end, to look and to step back; else the session ends"),
}
"""The exception filters by name: label and description. All are on by default."""
FILTER_OF: Final = {
    "trap": "trap",
    "cycle-limit": "cycle-limit",
    "outputs": "outputs",
    "halted": "end",
    "frames-exhausted": "end",
}
"""The filter of each reason that an exception can have in the debugger."""
_EXIT_CODES: Final = {"trap": 1, "cycle-limit": 3}
_REASONS: Final = {
    "frame": "step",
    "place": "step",
    "interrupted": "pause",
    "start": "entry",
    "trap": "exception",
    "cycle-limit": "exception",
    "outputs": "exception",
    "halted": "pause",
    "frames-exhausted": "pause",
}


class Stopped(NamedTuple):
    """A stop that the client is told of.

    Attributes:
        reason: as the protocol has it.
        description: a few words.
        text: a sentence on an exception.
        numbers: breakpoints that were hit.
    """

    reason: str
    description: str = ""
    text: str = ""
    numbers: tuple[int, ...] = ()

    def body(self) -> dict[str, Any]:
        """Return the body of the event."""
        body: dict[str, Any] = {"reason": self.reason}
        if self.description:
            body["description"] = self.description
        if self.text:
            body["text"] = self.text
        if self.numbers:
            body["hitBreakpointIds"] = list(self.numbers)
        return body


class Exit(NamedTuple):
    """The end of the program, with the exit code that ``npchip run`` has."""

    code: int


STEPPED: Final = Stopped("step")
PAUSED: Final = Stopped("pause", "paused")


def of(stop: Stop) -> Stopped:
    """Return a stop of the debugger that is not at breakpoints."""
    reason = _REASONS.get(stop.reason, stop.reason)
    text = stop.message if reason == "exception" else ""
    return Stopped(reason, stop.message, text, stop.numbers)


def at(stop: Stop, hit: Hit) -> Stopped:
    """Return a stop at breakpoints."""
    kind = hit.points[0].spec.kind if hit.points else "breakpoint"
    numbers = tuple(point.number for point in hit.points) or stop.numbers
    return Stopped(kind, stop.message, "", numbers)


def exited(stop: Stop) -> Exit:
    """Return the end of a run."""
    return Exit(_EXIT_CODES.get(stop.reason, 0))


def failed(fault: Exception) -> Stopped:
    """Return the stop where something was raised, such as by a frame that cannot be read."""
    if isinstance(fault, NpchipError):
        return Stopped("exception", fault.message, str(fault))
    text = f"internal error: {type(fault).__name__}: {fault} [NP259]"
    return Stopped("exception", text, text)
