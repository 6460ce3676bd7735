"""State of the adapter besides the debugger: the chosen NP, and how the client counts."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

from npchip.base.errors import InputError
from npchip.dap.arguments import Arguments
from npchip.dap.points import Points
from npchip.debugger.commands import Commands
from npchip.debugger.session import Debugger


@dataclass
class Client:
    """A client: how it counts lines, and what it understands.

    Attributes:
        first: number of the first line of a file, and of the first column.
        invalidated: whether it knows the event that values have changed.
    """

    first: int = 1
    invalidated: bool = False

    @classmethod
    def of(cls, arguments: Arguments) -> Client:
        """Return what a client says of itself.

        Raises:
            InputError: NP358, it names files as only URIs do.
        """
        form = arguments.text("pathFormat", "path")
        if form != "path":
            message = f"initialize: pathFormat: expected path, found {form}"
            raise InputError("NP358", message)
        starts_at_one = arguments.data.get("linesStartAt1", True)
        return cls(1 if starts_at_one else 0, arguments.flag("supportsInvalidatedEvent"))


@dataclass
class Session:
    """A debugger with what a client has chosen to see.

    Attributes:
        debugger: the debugger.
        client: the client.
        commands: the commands of the debugger.
        points: what stops a run.
        chosen: row and column of the chosen NP.
        handles: the numbers of what the client may ask the variables of, until the next movement.
    """

    debugger: Debugger
    client: Client
    commands: Commands = field(init=False)
    points: Points = field(init=False)
    chosen: tuple[int, int] = (0, 0)
    handles: dict[Any, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.commands = Commands(self.debugger)
        self.points = Points(self.debugger)

    def handle(self, node: Any) -> int:
        """Return the number of what variables may be asked of."""
        return self.handles.setdefault(node, len(self.handles) + 1)

    def node(self, number: int) -> Any:
        """Return what a number stands for.

        Raises:
            InputError: NP358, there is none, or it is of before the last movement.
        """
        if not 1 <= number <= len(self.handles):
            raise InputError("NP358", f"variablesReference {number}: nothing has this number now")
        return next(islice(self.handles, number - 1, None))

    def choose(self, row: int, column: int) -> None:
        """Choose an NP.

        Raises:
            InputError: NP351, the array has none there.
        """
        rows, columns = self.debugger.chip.machine.geometry
        if not (0 <= row < rows and 0 <= column < columns):
            message = f"np({row},{column}): the array has {rows} x {columns} NPs, from np(0,0) on"
            raise InputError("NP351", message)
        self.chosen = row, column

    def file_of(self, source: Arguments) -> str | None:
        """Return the program's name of a source file; None if it is none of the program's."""
        files = self.debugger.names.files
        number = source.number("sourceReference", 0)
        if number:
            return files[number - 1] if 1 <= number <= len(files) else None
        path = source.text("path", "")
        if path in files:
            return str(path)
        try:
            wanted = Path(path).resolve()
        except (OSError, ValueError):  # no path at all
            return None
        return next((file for file in files if path and Path(file).resolve() == wanted), None)
