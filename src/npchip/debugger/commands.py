"""The commands of the debugger, for scripts and for the command line of the screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple, get_args

import numpy as np

from npchip.assembler.diagnostics import Line, SourceError, did_you_mean, quoted
from npchip.assembler.expressions import COMPARISONS
from npchip.base.errors import InputError
from npchip.debugger import answers
from npchip.debugger.conditions import Reason, Stop
from npchip.debugger.language import Reader, understanding
from npchip.debugger.search import Written
from npchip.debugger.session import Breakpoint, Debugger
from npchip.debugger.values import Cell

REASONS: Final[tuple[str, ...]] = get_args(Reason)


class Command(NamedTuple):
    """The help on a command; its name is the first word of `syntax`."""

    syntax: str
    text: str
    short: str = ""

    @property
    def name(self) -> str:
        """First word of the syntax."""
        return self.syntax.split()[0]


COMMANDS: Final = (
    Command("break CONDITION", "stop at a place, or when something becomes true", "b"),
    Command("watch CONDITION", "the same", "w"),
    Command("delete N|all", "forget a breakpoint", "d"),
    Command("disable N", "switch a breakpoint off"),
    Command("enable N", "switch it on again"),
    Command("list", "the breakpoints", "l"),
    Command("step [N]", "execute one instruction, or N", "s"),
    Command("over", "execute one instruction, a call as a whole", "n"),
    Command("out", "go on to where the routine returns", "o"),
    Command("run [back]", "go on, or back, to a breakpoint or the end", "r"),
    Command("until CONDITION", "go on to a place or condition", "u"),
    Command("frame [back] [N]", "go to the next, or previous, expose", "f"),
    Command("back [N]", "undo one instruction, or N"),
    Command("goto N", "go to where N instructions had been executed", "g"),
    Command("restart", "go to the beginning; edits are forgotten"),
    Command("who PLACE", "which instruction wrote a register, flag, byte or pixel last"),
    Command("print VALUE", "show a value, np(R,C), outputs, stack or where", "p"),
    Command("edit PLACE = N", "set a register, flag, byte or pixel"),
    Command("expect TEST", "fail if it does not hold"),
)


class Reply(NamedTuple):
    """The answer to a command; `failed` tells that an expectation does not hold."""

    text: str
    failed: bool = False


class Commands:
    """Executes commands on a session.

    Args:
        debugger: the session.

    Attributes:
        found: the answer of the last `who`.
    """

    def __init__(self, debugger: Debugger) -> None:
        self.debugger = debugger
        self.found: Written | None = None
        self._table: dict[str, Callable[[Reader], str | Reply]] = {
            "break": self._break,
            "watch": self._break,
            "delete": self._delete,
            "disable": self._disable,
            "enable": self._enable,
            "list": self._list,
            "step": lambda reader: self._go(reader, debugger.step, self._count(reader)),
            "over": lambda reader: self._go(reader, debugger.step_over),
            "out": lambda reader: self._go(reader, debugger.step_out),
            "run": self._run,
            "until": lambda reader: self._go(reader, debugger.run_to, reader.condition()),
            "frame": self._frame,
            "back": lambda reader: self._go(reader, debugger.step_back, self._count(reader)),
            "goto": lambda reader: self._go(reader, debugger.seek, self._count(reader, least=0)),
            "restart": lambda reader: self._go(reader, debugger.restart),
            "who": self._who,
            "print": self._print,
            "edit": self._edit,
            "expect": self._expect,
        }
        self._short = {item.short: item.name for item in COMMANDS if item.short}

    def execute(self, text: str, file: str = "command", number: int = 1) -> Reply:
        """Execute a line. An empty one or a comment does nothing.

        Args:
            text: the line.
            file: the line's file in messages.
            number: its number in the file.

        Raises:
            CommandError: NP350, NP351, it cannot be read; NP352, a value cannot be set.
            InputError: a frame cannot be read.
        """
        with understanding():
            reader = Reader(Line(file, number, text), self.debugger.names)
            if reader.peek().ends:
                return Reply("")
            word = reader.peek().text
            name = self._short.get(word, word)
            if name not in self._table:
                commands = f"commands: {', '.join(self._table)}"
                raise reader.unknown_name("no command", reader.peek(), self._table, commands)
            reader.take()
            reply = self._table[name](reader)
        return reply if isinstance(reply, Reply) else Reply(reply)

    def picture(self, text: str) -> Cell | int | None:
        """Return the subject of ``show``: a cell, a bank by its first byte, or None for the frame.

        Raises:
            CommandError: NP350, NP351, it cannot be read.
        """
        with understanding():
            reader = Reader(Line("show", 1, text), self.debugger.names)
            shown: Cell | int | None = None
            if reader.accept("bank"):
                token = reader.peek()
                shown = reader.number()
                if shown not in range(0, len(self.debugger.chip.memory), 64):
                    raise reader.unknown(f"{shown} is not the first byte of a bank", token)
            elif not reader.accept("frame"):
                shown = reader.cell()
            reader.end()
        return shown

    def processor(self, text: str) -> tuple[int, int]:
        """Return row and column of the NP that is written ``R C``, ``R,C`` or ``(R,C)``.

        Raises:
            CommandError: NP350, NP351, it cannot be read.
        """
        numbers = text.replace("(", " ").replace(")", " ").replace(",", " ").split()
        line = Line("np", 1, f"np({','.join(numbers)})")
        with understanding():
            return Reader(line, self.debugger.names).processor()

    # ---- forward and back

    def _go(self, reader: Reader, move: Callable[..., Stop], *arguments: Any) -> str:
        reader.end()
        stop = move(*arguments)
        where = answers.where(self.debugger)
        return f"{stop.message}; {where}" if stop.message else where

    def _count(self, reader: Reader, least: int = 1) -> int:
        token = reader.peek()
        count = 1 if token.ends and least else reader.number("a number")
        if count < least:
            raise reader.unknown(f"expected a number from {least} on, found {count}", token)
        return count

    def _run(self, reader: Reader) -> str:
        back = reader.accept("back")
        return self._go(reader, self.debugger.run_back if back else self.debugger.run)

    def _frame(self, reader: Reader) -> str:
        back = reader.accept("back")
        move = self.debugger.previous_frame if back else self.debugger.next_frame
        return self._go(reader, move, self._count(reader))

    # ---- what stops a run

    def _break(self, reader: Reader) -> str:
        condition = reader.condition()
        reader.end()
        added = self.debugger.add_condition(condition)
        places = ", ".join(map(str, sorted(condition.places)))
        at = f" (address {places})" if places else ""
        return f"breakpoint {added.number}: {added.text}{at}"

    def _breakpoint(self, reader: Reader) -> Breakpoint:
        token, known = reader.peek(), self.debugger.breakpoints
        number = reader.number("the number of a breakpoint")
        reader.end()
        if number not in known:
            hint = ", ".join(map(str, known)) or "there is none"
            raise reader.unknown(f"no breakpoint {number}", token, hint)
        return known[number]

    def _delete(self, reader: Reader) -> str:
        if reader.accept("all"):
            reader.end()
            self.debugger.breakpoints.clear()
            return "no breakpoints"
        number = self._breakpoint(reader).number
        del self.debugger.breakpoints[number]
        return f"breakpoint {number} deleted"

    def _disable(self, reader: Reader) -> str:
        item = self._breakpoint(reader)
        item.enabled = False
        return f"breakpoint {item.number} is off"

    def _enable(self, reader: Reader) -> str:
        item = self._breakpoint(reader)
        if item.error:
            return f"breakpoint {item.number} cannot be used: {item.error}"
        item.enabled = True
        return f"breakpoint {item.number} is on"

    def _list(self, reader: Reader) -> str:
        reader.end()
        lines = [
            f"{item.number}  {'on ' if item.enabled else 'off'}  {item.text}"
            + (f"  ({item.error})" if item.error else "")
            for item in self.debugger.breakpoints.values()
        ]
        return "\n".join(lines) or "no breakpoints"

    # ---- values

    def _who(self, reader: Reader) -> str:
        text = reader.rest()
        location = reader.location()
        reader.end()
        written = self.found = self.debugger.who(location)
        return "interrupted" if written is None else answers.told(written, text)

    def _print(self, reader: Reader) -> str:
        chip = self.debugger.chip
        word = reader.peek().text
        if word in {"outputs", "stack", "where"} and reader.peek(1).ends:
            if word == "where":
                return answers.where(self.debugger)
            if word == "stack":
                return " ".join(map(str, chip.stack)) or "no call is open"
            return answers.outputs(self.debugger)
        if word == "np":
            row, column = reader.processor()
            if reader.peek().ends:
                return answers.processor(self.debugger, row, column)
            reader = reader.again()
        text = reader.rest()
        value = reader.value()
        reader.end()
        return f"{text} = {answers.shown(value, self.debugger)}"

    def _edit(self, reader: Reader) -> str:
        token = reader.peek()
        target = reader.value()
        if not isinstance(target, Cell):
            reader = reader.again()
            target = reader.location()
        reader.sign("=")
        value = reader.number("the new value")
        reader.end()
        try:
            forgotten = self.debugger.edit(target, value)
        except InputError as fault:
            raise SourceError(fault.code, fault.message, token.span) from None
        later = f"; {forgotten} later edits are forgotten" if forgotten else ""
        return f"{target} = {value}{later}"

    def _expect(self, reader: Reader) -> Reply:
        text = reader.rest()
        if reader.accept("stop"):
            return self._expect_stop(reader)
        if reader.accept("output"):
            return self._expect_output(reader, text)
        test = reader.test()
        reader.end()
        if test.holds(self.debugger.chip):
            return Reply(f"holds: {text}")
        found = answers.found(test, self.debugger)
        return Reply(f"expected {text}; found {found}", failed=True)

    def _expect_stop(self, reader: Reader) -> Reply:
        reader.sign("==")
        token = reader.peek()
        wanted = reader.rest()
        if wanted not in REASONS:
            near = did_you_mean(wanted, REASONS) or f"one of {', '.join(REASONS)}"
            raise reader.unknown(f"no reason to stop {quoted(wanted)}", token, near)
        stop = self.debugger.stop
        if stop.reason == wanted:
            return Reply(f"holds: stop == {wanted}")
        return Reply(f"expected stop == {wanted}; found {stop.reason}: {stop.message}", failed=True)

    def _expect_output(self, reader: Reader, text: str) -> Reply:
        outputs = self.debugger.outputs
        token = reader.take()
        if token.text not in outputs:
            hint = f"outputs: {', '.join(outputs)}"
            raise reader.unknown_name("no output", token, outputs, hint)
        op = reader.operation()
        number = reader.number()
        reader.end()
        value = outputs[token.text]
        if isinstance(value, int) and COMPARISONS[op](value, number):
            return Reply(f"holds: {text}")
        found = "nothing sent" if value is None else value
        if isinstance(value, np.ndarray):
            found = "a plane; only scalars are compared"
        return Reply(f"expected {text}; found {found}", failed=True)
