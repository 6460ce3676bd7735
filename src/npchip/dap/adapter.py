"""The adapter: one client, one program, and what they say to each other.

One thread reads messages, one moves the program, and the main thread does all else: it answers, and
decides after each leg of a movement whether the program stops there.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable
from functools import partial
from queue import Empty, SimpleQueue
from threading import Thread
from typing import BinaryIO, Final, NamedTuple

from npchip.base.errors import InputError, NpchipError
from npchip.dap import evaluate, movement, stops, wire
from npchip.dap.arguments import Arguments
from npchip.dap.launch import launch
from npchip.dap.movement import MOVEMENTS, Movement, Worker
from npchip.dap.requests import CAPABILITIES, READING, SETTING, STILL
from npchip.dap.session import Client, Session
from npchip.debugger import answers
from npchip.debugger.language import CommandError
from npchip.run.result import FrameRecord

_LOOK: Final = 0.1
"""Seconds between two looks at a program that runs."""


class _Ended(NamedTuple):
    """The client has gone; `fault` says what was wrong."""

    fault: NpchipError | None = None


class _Moved(NamedTuple):
    """A leg is done; `fault` was raised in it."""

    fault: Exception | None = None


class Adapter:
    """Serves a client until it ends.

    Args:
        source: where it writes.
        out: where it reads.
    """

    def __init__(self, source: BinaryIO, out: BinaryIO) -> None:
        self._source = source
        self._writer = wire.Writer(out)
        self._inbox: SimpleQueue[wire.Message | _Moved | _Ended] = SimpleQueue()
        self._worker = Worker(lambda fault: self._inbox.put(_Moved(fault)))
        self._client: Client | None = None
        self._session: Session | None = None
        self._stop_on_entry = False
        self._debug = True
        self._configured = False
        self._filters = set(stops.FILTERS)
        self._movement: Movement | None = None
        self._origin: tuple[int, str] = (0, "")  # time and reason of the stop before
        self._asked: wire.Message | None = None  # a command that moves, to be answered at its end
        self._said: list[str] = []
        self._pausing = False
        self._waiting: list[wire.Message] = []  # requests that interrupt the movement
        self._frames: deque[tuple[int, FrameRecord]] = deque()
        self._told = -2  # the last frame that the client was told of
        self._over = False

    def serve(self) -> int:
        """Serve the client.

        Returns:
            the exit code: 0 if it has said that it ends, else 1.

        Raises:
            InputError: NP359, it sends what cannot be read.
        """
        Thread(target=self._read, name="npchip-dap-in", daemon=True).start()
        try:
            return self._serve()
        finally:
            self._worker.end()

    def _serve(self) -> int:
        while not self._over and not self._writer.closed:
            try:
                item = self._inbox.get(timeout=_LOOK if self._movement else None)
            except Empty:
                self._look()
                continue
            match item:
                case _Moved(fault=fault):
                    self._moved(fault)
                case _Ended(fault=fault):
                    if fault is not None:
                        raise fault
                    return 1
                case _:
                    self._receive(item)
        return 0 if self._over else 1

    def _read(self) -> None:
        def complain(text: str) -> None:
            print(f"npchip dap: {text}", file=sys.stderr)  # noqa: T201 - an editor shows it

        fault: NpchipError | None = None
        try:
            for message in wire.read(self._source, complain):
                self._inbox.put(message)
        except NpchipError as error:
            fault = error
        except (OSError, ValueError, MemoryError):  # what cannot be read any more has ended
            pass
        self._inbox.put(_Ended(fault))

    # ---- requests

    def _receive(self, message: wire.Message) -> None:
        if message.get("type") != "request" or not isinstance(message.get("command"), str):
            return
        self._try(message, lambda: self._request(message, str(message["command"])))

    def _try(self, message: wire.Message, answer: Callable[[], None]) -> None:
        """Answer a request, or say why that has failed."""
        try:
            answer()
        except NpchipError as fault:
            self._writer.failure(message, str(fault))
        except Exception as fault:  # noqa: BLE001 - the client is told, and goes on
            text = f"internal error: {type(fault).__name__}: {fault} [NP259]"
            self._writer.failure(message, text)

    def _request(self, message: wire.Message, command: str) -> None:
        arguments = Arguments(command, message.get("arguments"))
        match command:
            case "initialize":
                self._client = Client.of(arguments)
                self._writer.response(message, CAPABILITIES)
            case "launch":
                self._launch(message, arguments)
            case "disconnect":
                self._over = True
                self._writer.response(message)
            case "attach":
                why = "attach: nothing runs that could be attached to"
                raise InputError("NP358", why, hint="launch a program instead")
            case _ if self._session is None:
                raise InputError("NP358", f"{command}: no program has been launched")
            case _:
                self._in_session(self._session, message, command, arguments)

    def _in_session(
        self, session: Session, message: wire.Message, command: str, arguments: Arguments
    ) -> None:
        if command == "pause":
            self._pausing = self._movement is not None
            self._writer.response(message)
            self._look()
        elif command == "threads":
            self._writer.response(message, {"threads": [{"id": 1, "name": _thread(session)}]})
        elif command == "configurationDone":
            self._writer.response(message)
            self._configure(session)
        elif command == "setExceptionBreakpoints":
            options = arguments.items("filterOptions")
            wanted = {*arguments.texts("filters"), *(item.text("filterId") for item in options)}
            self._filters = wanted if self._debug else set()
            self._writer.response(message)
        elif command in READING:
            self._writer.response(message, READING[command](session, arguments))
        elif self._movement is not None:
            self._while_moving(message, command)
        elif command in MOVEMENTS:
            made = MOVEMENTS[command](session.debugger)
            all_of_it = {"allThreadsContinued": True} if command == "continue" else {}
            self._writer.response(message, all_of_it)
            self._begin(made)
        elif command == "evaluate" and (name := evaluate.lasting(arguments)):
            self._command(session, message, name, arguments.text("expression").strip())
        elif command in SETTING:
            self._set(session, message)
        elif command in STILL:
            self._still(session, message, command, arguments)
        else:
            raise InputError("NP358", f"there is no request {command}")

    def _still(
        self, session: Session, message: wire.Message, command: str, arguments: Arguments
    ) -> None:
        chosen, edits = session.chosen, session.debugger.edits
        numbers = set(session.debugger.breakpoints)
        self._writer.response(message, STILL[command](session, arguments))
        if session.debugger.edits != edits:
            session.points.forget(session.debugger.time)
            self._told = min(self._told, session.debugger.chip.frames_taken - 2)
        changed = (session.chosen, session.debugger.edits) != (chosen, edits)
        if changed and session.client.invalidated:
            areas = ["stacks", "variables"] if session.chosen != chosen else ["variables"]
            self._writer.event("invalidated", {"areas": areas})
        self._tell_breakpoints(session, numbers)

    def _tell_breakpoints(self, session: Session, before: set[int]) -> None:
        """Tell of breakpoints that a command has made or deleted."""
        now = session.debugger.breakpoints
        for number in sorted(before - now.keys()):
            gone = {"id": number, "verified": False}
            self._writer.event("breakpoint", {"reason": "removed", "breakpoint": gone})
        for number in sorted(now.keys() - before):
            body = {"id": number, "verified": True, "message": now[number].text}
            self._writer.event("breakpoint", {"reason": "new", "breakpoint": body})

    def _while_moving(self, message: wire.Message, command: str) -> None:
        if command in SETTING:
            self._waiting.append(message)
            self._look()
        elif command in {*MOVEMENTS, *STILL}:
            self._writer.failure(message, f"{command}: the program runs", "notStopped")
        else:
            raise InputError("NP358", f"there is no request {command}")

    # ---- the life of a program

    def _launch(self, message: wire.Message, arguments: Arguments) -> None:
        if self._session is not None:
            raise InputError("NP358", "launch: a program has been launched already")
        launched = launch(arguments, lambda text: self._say(text, "important"))
        self._debug, self._stop_on_entry = launched.debug, launched.stop_on_entry
        self._session = session = Session(launched.debugger, self._client or Client())
        session.points.on = self._debug
        if not self._debug:
            self._filters = set()
        session.debugger.tell_frames(lambda frame, record: self._frames.append((frame, record)))
        self._writer.response(message)
        self._writer.event("initialized")

    def _configure(self, session: Session) -> None:
        if self._configured or self._movement is not None:
            return
        self._configured = True
        if self._stop_on_entry and self._debug:
            self._stopped(session, stops.of(session.debugger.stop))
        else:
            self._begin(MOVEMENTS["continue"](session.debugger))

    def _terminate(self, code: int) -> None:
        self._writer.event("exited", {"exitCode": code})
        self._writer.event("terminated")

    def _say(self, text: str, category: str = "console") -> None:
        self._writer.event("output", {"category": category, "output": f"{text}\n"})

    # ---- movements

    def _command(self, session: Session, message: wire.Message, name: str, text: str) -> None:
        """Begin what a command of the console does; it is answered at its end."""
        self._asked, self._said = message, []
        if name == "restart":  # which forgets the edits, so that all may be otherwise
            self._told = -2
            session.points.forget(0)
        self._begin(movement.commanded(session, name, text, self._said))

    def _begin(self, made: Movement) -> None:
        assert self._session is not None
        debugger = self._session.debugger
        self._origin = debugger.time, debugger.stop.reason
        self._movement = made
        self._worker.begin(made.leg)

    def _look(self) -> None:
        """Tell of frames; interrupt where the client wants it: a movement may have missed it."""
        self._tell_frames()
        if self._movement and (self._pausing or self._waiting):
            assert self._session is not None
            self._session.debugger.interrupt()

    def _moved(self, fault: Exception | None) -> None:
        session, made = self._session, self._movement
        assert session is not None
        assert made is not None
        self._tell_frames()
        stop = stops.failed(fault) if fault is not None else self._judged(session, made)
        if stop is None and made.again is not None and not self._pausing:
            self._set_waiting(session)
            self._worker.begin(made.again)
            return
        self._movement, self._pausing = None, False
        if self._asked is not None:
            self._answer_command(session, self._asked, made, fault)
            self._asked = None
        if isinstance(stop, stops.Exit):
            self._terminate(stop.code)
        elif not (made.still or isinstance(fault, CommandError)):  # nothing has moved
            self._stopped(session, stop or stops.PAUSED)
        self._set_waiting(session)

    def _judged(self, session: Session, made: Movement) -> stops.Stopped | stops.Exit | None:
        """Return the stop or the end after a leg; None to go on with the next leg."""
        debugger = session.debugger
        stop = debugger.stop
        if made.still or stop.reason == "interrupted":
            return None
        if stop.reason == "breakpoint":
            hit = session.points.hit(stop, back=made.back)
            for text in hit.said:
                self._say(text)
            if hit.points or hit.unknown or made.again is None:
                return stops.at(stop, hit)
            return stops.STEPPED if made.done() else None
        if stop.reason in stops.FILTER_OF and not made.back:
            standing = self._origin == (debugger.time, stop.reason) and stop.reason != "outputs"
            if standing or stops.FILTER_OF[stop.reason] not in self._filters:
                return stops.exited(stop) if stop.reason != "outputs" else None
        return stops.of(stop)

    def _answer_command(
        self, session: Session, asked: wire.Message, made: Movement, fault: Exception | None
    ) -> None:
        if isinstance(fault, NpchipError):
            self._writer.failure(asked, str(fault))
            return
        text = self._said[-1] if self._said else answers.where(session.debugger)
        self._writer.response(asked, {"result": text, "variablesReference": 0})
        if not made.still:
            self._writer.event("continued", {"threadId": 1, "allThreadsContinued": True})

    def _set_waiting(self, session: Session) -> None:
        waiting, self._waiting = self._waiting, []
        for message in waiting:
            self._try(message, partial(self._set, session, message))

    def _set(self, session: Session, message: wire.Message) -> None:
        command = message["command"]
        arguments = Arguments(command, message.get("arguments"))
        self._writer.response(message, SETTING[command](session, arguments))

    def _stopped(self, session: Session, stop: stops.Stopped) -> None:
        session.handles.clear()
        self._writer.event("stopped", {"threadId": 1, "allThreadsStopped": True, **stop.body()})

    def _tell_frames(self) -> None:
        """Tell of frames that are complete, each once."""
        lines = []
        while self._frames:
            number, record = self._frames.popleft()
            if number > self._told:
                self._told = number
                lines.append(answers.frame(number, record))
        if lines:
            self._say("\n".join(lines), "stdout")


def _thread(session: Session) -> str:
    debugger = session.debugger
    rows, columns = debugger.chip.machine.geometry
    return f"{debugger.program.name} on {debugger.chip.machine.name}, {rows} x {columns} NPs"


def serve() -> int:
    """Serve one client on standard input and output; return the exit code of `Adapter.serve`.

    Raises:
        InputError: as `Adapter.serve`.
    """
    # What else might be printed must not come between messages.
    out = os.fdopen(os.dup(1), "wb")
    source = os.fdopen(os.dup(0), "rb")
    os.dup2(2, 1)
    return Adapter(source, out).serve()
