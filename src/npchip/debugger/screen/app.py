"""The terminal application: turns keys into commands and shows their effect."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar, Final, NamedTuple

from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.events import Event, Key
from textual.widgets import Input, Static

from npchip.base.errors import NpchipError
from npchip.debugger import store
from npchip.debugger.answers import where
from npchip.debugger.commands import Commands
from npchip.debugger.language import parse_condition
from npchip.debugger.screen.keys import BINDINGS
from npchip.debugger.screen.look import Look, Shown
from npchip.debugger.screen.panes import Panes, View
from npchip.debugger.screen.picture import Picture
from npchip.debugger.screen.popup import CLOSING, SCROLLING, Popup, help_text
from npchip.debugger.screen.source import Source
from npchip.debugger.screen.worker import Worker
from npchip.debugger.search import Written
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One

_HINT: Final = (
    "? help  : command  s step  S back  n over  r run  R run back  f frame  b break  w who wrote it"
)


class _Done(NamedTuple):
    """The answer to a command, the session after it and the cycles that it executed."""

    text: str
    look: Look
    cycles: int


class DebugApp(App[None]):
    """The screen of a debugging session.

    Args:
        debugger: the session.
        breakpoints: file to save the breakpoints in; None saves none.
        messages: first messages to show.
    """

    TITLE = "npchip debug"
    ENABLE_COMMAND_PALETTE = False
    CSS = """
    Screen { layout: vertical; }
    #message { height: 2; background: $surface; }
    #hint { height: 1; color: $text-muted; }
    #command { height: 1; border: none; padding: 0; display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [*BINDINGS]

    def __init__(
        self, debugger: Debugger, breakpoints: Path | None = None, messages: list[str] | None = None
    ) -> None:
        super().__init__()
        self._debugger = debugger
        self._commands = Commands(debugger)
        self._file = breakpoints
        self._messages = messages or []
        self._saved = self._signature()
        machine = debugger.chip.machine
        self._banks: list[Shown] = [None, *range(0, machine.memory_bytes, 64)]
        self._cells: list[Shown] = [
            *(Cell("register", number) for number in range(16)),
            Cell("flag", "Z"),
            Cell("flag", "C"),
            Cell("active"),
        ]
        self._shown: Shown = None
        self._other: Shown = self._cells[0]
        self._pixel = (0, 0)
        self._look = Look(debugger)
        self._since = 0  # cycles since the last stop
        self._worker = Worker[_Done](self, self._done)
        self._found: Written | None = None
        self._late: list[Key] | None = None  # keys after the enter of the command line

    # ---- building

    def compose(self) -> ComposeResult:
        """Yield the panes, the message line and the command line."""
        yield Panes(self._debugger, self._view())
        yield Static(id="message", markup=False)
        yield Input(id="command", placeholder="a command; escape leaves, ? lists them")
        yield Static(_HINT, id="hint", markup=False)

    def on_mount(self) -> None:
        """Show the session as it begins."""
        self.query_one(Source).focus()
        self.set_interval(0.2, self._tick)
        begin = f"{self._debugger.program.name}: {where(self._debugger)}"
        self._say("; ".join(self._messages) or begin)
        self._draw(follow=True)

    # ---- drawing

    def _view(self) -> View:
        return View(self._look, self._since, self._shown, self._pixel)

    def _draw(self, *, follow: bool = False) -> None:
        self.query_one(Panes).show(self._view(), follow=follow)

    def _say(self, text: str) -> None:
        if "\n" in text.strip():
            self.push_screen(Popup(text, "answer"))
            text = text.strip().splitlines()[0]
        self._tell(text)

    def _tell(self, text: str) -> None:
        self.query_one("#message", Static).update(text)

    # ---- working in another thread

    def _queue(self, work: Callable[[], str]) -> None:
        """Queue a task for the worker thread."""

        def task() -> _Done:
            before = self._debugger.chip.cycles
            try:
                text = work()
            except (NpchipError, OSError, MemoryError) as error:
                text = _brief(error)
            look = Look(self._debugger)
            return _Done(text, look, look.cycles - before)

        self._worker.do(task)

    def _done(self, done: _Done) -> None:
        text, look, cycles = done
        moved = (look.instructions, look.stop) != (self._look.instructions, self._look.stop)
        self._look = look
        if moved:
            self._since = cycles
        if self._signature() != self._saved:
            text = self._save() or text
        self._say(text)
        self._draw(follow=moved)

    def _tick(self) -> None:
        if self._worker.under_way:
            chip = self._debugger.chip
            now = f"frame {chip.frames_taken - 1}, cycle {chip.cycles:,}"
            self._tell(f"working: {now}; escape interrupts")

    def _signature(self) -> list[tuple[str, bool]]:
        return [(item.text, item.enabled) for item in self._debugger.breakpoints.values()]

    def _save(self) -> str:
        self._saved = self._signature()
        if self._file is not None:
            try:
                store.save(self._debugger, self._file)
            except NpchipError as error:
                return _brief(error)
        return ""

    # ---- keys

    async def on_event(self, event: Event) -> None:
        """Take keys in their order, also those that come while a popup or a command ends."""
        if isinstance(event, Key) and not event.is_forwarded and not self._takes(event):
            return
        await super().on_event(event)

    def _takes(self, event: Key) -> bool:
        """Return whether a key is to be handled now. Most close a popup, and do their work too."""
        if self._late is not None:
            self._late.append(event)
            return False
        if isinstance(self.focused, Input) and event.key == "enter":
            self._late = []
        if isinstance(self.screen, Popup) and event.key not in SCROLLING:
            self.screen.dismiss()
            return event.key not in CLOSING
        return True

    def action_do(self, command: str) -> None:
        """Execute a command."""
        self._queue(lambda: self._commands.execute(command).text)

    async def action_quit(self) -> None:
        """Interrupt the running task and quit."""
        self._worker.forget()
        self._debugger.interrupt()
        self.exit()

    def action_interrupt(self) -> None:
        """Interrupt the running task and close the command line."""
        self.close_command()
        self._worker.forget()
        self._debugger.interrupt()

    def action_to_cursor(self) -> None:
        """Run to the line at the cursor."""
        line = self._line_at_cursor()
        if line:
            self.action_do(f"until {line}")

    def _line_at_cursor(self) -> str:
        """Return the line at the cursor as a place; show a message if there is none."""
        source = self.query_one(Source)
        row = source.rows[source.cursor]
        if not row.addresses:
            self._say("no instruction at the cursor")
            return ""
        if not source.file:
            return str(row.addresses[0])
        return self._debugger.names.line_called(source.file, row.number)

    def action_breakpoint(self) -> None:
        """Set or delete the breakpoint at the cursor."""
        line = self._line_at_cursor()
        if not line:
            return

        def toggle() -> str:
            points, names = self._debugger.breakpoints, self._debugger.names
            places = parse_condition(line, names).places
            for number, item in list(points.items()):
                if item.condition and item.condition.places == places:
                    del points[number]
                    return f"breakpoint {number} deleted"
            return self._commands.execute(f"break {line}").text

        self._queue(toggle)

    def _location(self) -> str:
        """Return the shown cell or pixel of the selected NP in the syntax of commands."""
        y, x = self._pixel
        if isinstance(self._shown, Cell):
            return str(One(self._shown, y // 8, x // 8))
        return f"pixel({y},{x})" if self._shown is None else f"pixel({y},{x},{self._shown})"

    def action_who(self) -> None:
        """Find the last write to the shown cell or pixel."""
        self._who(self._location())

    def _who(self, location: str) -> None:
        def who() -> str:
            text = self._commands.execute(f"who {location}").text
            self._found = self._commands.found
            return f"{text}   (g goes there)" if self._found else text

        self._queue(who)

    def action_go(self) -> None:
        """Go to the time before the write that was found."""
        if self._found is None or self._found.by == "nobody":
            self._say("w finds out who wrote what is shown")
        else:
            self.action_do(f"goto {max(0, self._found.time - 1)}")

    def action_edit(self) -> None:
        """Open the command line to edit the shown cell or pixel."""
        self.open_command(f"edit {self._location()} = ")

    def action_command(self) -> None:
        """Open the command line."""
        self.open_command("")

    def action_pick(self, rows: int, columns: int) -> None:
        """Move the selection by some pixels."""
        machine = self._debugger.chip.machine
        y = max(0, min(machine.rows - 1, self._pixel[0] + rows))
        x = max(0, min(machine.cols - 1, self._pixel[1] + columns))
        self._select((y, x))

    def _select(self, pixel: tuple[int, int]) -> None:
        self._pixel = pixel
        self._draw()
        self.query_one(Picture).reveal()

    def on_picture_picked(self, event: Picture.Picked) -> None:
        """Select the pixel that was clicked on."""
        self._select(event.pixel)

    def action_arrow(self, rows: int, columns: int) -> None:
        """Move the selection if the picture has the focus, else the cursor and the text."""
        if isinstance(self.focused, Picture):
            self.action_pick(8 * rows, 8 * columns)
        else:
            self.query_one(Source).move(rows, columns)

    @property
    def fault(self) -> Exception | None:
        """The exception that has ended the application, which is a mistake in it."""
        return self._exception

    def _fatal_error(self) -> None:
        self._close_messages_no_wait()  # Textual's own would print a traceback as well

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable all actions but interrupt and quit while a popup or the command line is open."""
        if isinstance(self.screen, Popup) or isinstance(self.focused, Input):
            return action in {"interrupt", "quit"}
        return super().check_action(action, parameters)

    def action_cycle(self, step: int) -> None:
        """Show the next register or flag, or the next bank."""
        group = self._cells if isinstance(self._shown, Cell) else self._banks
        index = group.index(self._shown) if self._shown in group else -step
        self._shown = group[(index + step) % len(group)]
        self._draw()

    def action_plane(self) -> None:
        """Switch between pixels and values."""
        self._shown, self._other = self._other, self._shown
        self._draw()

    def action_file(self) -> None:
        """Show the next source file."""
        self.query_one(Source).switch()
        self.query_one(Panes).heads()

    def action_help(self) -> None:
        """Show the help."""
        self.push_screen(Popup(help_text(), "help"))

    # ---- the command line

    def open_command(self, text: str) -> None:
        """Show the command line with the beginning of a command."""
        line = self.query_one("#command", Input)
        line.styles.display = "block"
        self.query_one("#hint").styles.display = "none"
        line.value = text
        self.screen.set_focus(line)  # at once, as the next key is already for this line
        line.cursor_position = len(text)

    def on_input_blurred(self) -> None:
        """Close the command line when the keys go to another pane, not to another window."""
        if self.app_focus:
            self.close_command()

    def close_command(self) -> None:
        """Hide the command line."""
        line = self.query_one("#command", Input)
        if line.styles.display != "none":
            line.styles.display = "none"
            self.query_one("#hint").styles.display = "block"
            self.screen_stack[0].set_focus(self.query_one(Source))  # at once, too

    async def on_input_submitted(self, event: Input.Submitted) -> None:
        """Execute the command that was entered, then the keys that came after it."""
        self.close_command()
        self._enter(event.value.strip())
        keys, self._late = self._late or [], None
        for key in keys:
            await self.on_event(key)

    def _enter(self, text: str) -> None:
        word, _, rest = text.partition(" ")
        if word in {"?", "help"}:
            self.action_help()
        elif word in {"q", "quit"}:
            self.exit()
        elif word == "show":
            self._show(rest.strip())
        elif word == "np":
            self._queue(lambda: self._pick_np(rest))
        elif word == "who":
            self._who(rest)
        else:
            self.action_do(text)

    def _show(self, text: str) -> None:
        try:
            shown = self._commands.picture(text)
        except NpchipError as error:
            self._say(_brief(error))
            return
        if isinstance(shown, Cell) != isinstance(self._shown, Cell):
            self._other = self._shown
        self._shown = shown
        self._draw()

    def _pick_np(self, text: str) -> str:
        row, column = self._commands.processor(text)
        self.call_from_thread(self._select, (8 * row, 8 * column))
        return f"np({row},{column})"


def _brief(error: Exception) -> str:
    """Return an error on one line, as a popup would take the next key."""
    if not isinstance(error, NpchipError):
        return f"error: {str(error) or 'no memory is left'}"
    return f"error: {error.message} [{error.code}]" + (f": {error.hint}" if error.hint else "")
