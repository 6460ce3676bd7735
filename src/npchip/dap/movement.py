"""Movements of the program, and the thread that makes them."""

from __future__ import annotations

from collections.abc import Callable
from queue import SimpleQueue
from threading import Thread
from typing import Final, NamedTuple

from npchip.dap.evaluate import SEARCHING
from npchip.dap.session import Session
from npchip.debugger.language import parse_condition
from npchip.debugger.session import Debugger

Leg = Callable[[], object]


class Movement(NamedTuple):
    """A movement, which may have several legs: log points and changes interrupt it.

    Attributes:
        leg: the first leg.
        again: goes on after a stop that does not count; None for a movement that ends there.
        done: tells after a leg whether the movement has reached what it was for.
        back: whether it leads to the past.
        still: whether it ends where it began: a search, of whose end nobody is told as a stop.
    """

    leg: Leg
    again: Leg | None
    done: Callable[[], bool] = lambda: False
    back: bool = False
    still: bool = False


def _go_on(debugger: Debugger) -> Movement:
    return Movement(debugger.run, debugger.run)


def _into(debugger: Debugger) -> Movement:
    begin = debugger.time
    return Movement(debugger.step, debugger.step, lambda: debugger.time > begin)


def _over(debugger: Debugger) -> Movement:
    if not debugger.at_call:
        return _into(debugger)
    return _up_to(debugger, debugger.step_over, len(debugger.chip.stack))


def _out(debugger: Debugger) -> Movement:
    if not debugger.chip.stack:
        return Movement(debugger.step_out, None)
    return _up_to(debugger, debugger.step_out, len(debugger.chip.stack) - 1)


def _up_to(debugger: Debugger, leg: Leg, depth: int) -> Movement:
    """Return a movement that ends when at most `depth` calls are open."""
    returned = parse_condition(f"calls <= {depth}", debugger.names)
    begin = debugger.time
    return Movement(
        leg,
        lambda: debugger.run_to(returned),
        lambda: debugger.time > begin and len(debugger.chip.stack) <= depth,
    )


def _back(debugger: Debugger) -> Movement:
    target = max(0, debugger.time - 1)
    return Movement(debugger.step_back, lambda: debugger.seek(target), back=True)


def _go_back(debugger: Debugger) -> Movement:
    return Movement(debugger.run_back, debugger.run_back, back=True)


MOVEMENTS: Final[dict[str, Callable[[Debugger], Movement]]] = {
    "continue": _go_on,
    "stepIn": _into,
    "next": _over,
    "stepOut": _out,
    "stepBack": _back,
    "reverseContinue": _go_back,
}
"""Movements of the program, by the request that asks for them."""


def commanded(session: Session, command: str, text: str, answers: list[str]) -> Movement:
    """Return the movement of a command of the debugger.

    Args:
        session: the session.
        command: its name.
        text: all of it.
        answers: what it answers is appended.
    """

    def execute() -> None:
        answers.append(session.commands.execute(text).text)

    if command in SEARCHING:
        return Movement(execute, None, still=True)
    repeats = command in {"run", "until", "goto"}
    back = " back" in text or command in {"back", "restart"}
    return Movement(execute, execute if repeats else None, back=back)


class Worker:
    """A thread that makes the legs of movements.

    Args:
        done: called there after each leg, with what was raised in it.
    """

    def __init__(self, done: Callable[[Exception | None], None]) -> None:
        self._done = done
        self._legs: SimpleQueue[Leg | None] = SimpleQueue()
        Thread(target=self._work, name="npchip-dap", daemon=True).start()

    def begin(self, leg: Leg) -> None:
        """Make a leg. The one before must be done."""
        self._legs.put(leg)

    def end(self) -> None:
        """End the thread after the present leg."""
        self._legs.put(None)

    def _work(self) -> None:
        while (leg := self._legs.get()) is not None:
            try:
                leg()
            except Exception as fault:  # noqa: BLE001 - the client is told, whatever it is
                self._done(fault)
            else:
                self._done(None)
