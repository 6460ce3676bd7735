"""A client for tests: dap-python's own over the real process, with all events kept."""

from __future__ import annotations

import os
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Thread
from typing import IO, Any

from dap import Client as Protocol
from dap.base import ErrorResponse, Event, Response
from dap.events import OutputEvent, StoppedEvent
from dap.handler import Handler
from dap.responses import SetBreakpointsResponse

from npchip.dap.adapter import Adapter

ROOT = Path(__file__).parents[2]
TIMEOUT = 60.0


class Failed(Exception):  # noqa: N818 - the protocol calls it so
    """A request has failed; the text is what the user sees."""


class _Handler(Handler):  # type: ignore[misc]
    """dap-python's, but for what it reads otherwise than the protocol says.

    It takes an empty body for a whole response, numbers of breakpoints for texts, and
    ``exceptionId`` for ``exceptionID``. It knows neither the addresses of instructions nor
    whether a function breakpoint is verified.
    """

    def handle_response(self, response: Response) -> Any:
        command = response.command
        if response.success and (not response.body or command == "disassemble"):
            self.client._pending_requests.pop(response.request_seq)  # noqa: SLF001
            return response
        if response.success and command == "setFunctionBreakpoints":
            self.client._pending_requests.pop(response.request_seq)  # noqa: SLF001
            return SetBreakpointsResponse.model_validate(response.body)
        if response.success and command == "exceptionInfo":
            response.body["exceptionID"] = response.body.pop("exceptionId")
        return super().handle_response(response)

    def handle_event(self, event: Event) -> Any:
        if event.body and "hitBreakpointIds" in event.body:
            event.body["hitBreakpointIds"] = [str(item) for item in event.body["hitBreakpointIds"]]
        return event.event, super().handle_event(event)


class Client:
    """A client that asks one thing at a time.

    Args:
        to: what the adapter reads.
        source: what it writes.

    Attributes:
        events: the names and bodies of all events, in order.
        capabilities: what the adapter can do.
    """

    def __init__(self, to: IO[bytes], source: IO[bytes]) -> None:
        self._to = to
        self._source = source
        self.events: list[tuple[str, Any]] = []
        self.protocol = Protocol("npchip", lines_start_at1=True, columns_start_at1=True)
        self.protocol.handler = _Handler(self.protocol)
        self._seen = 0
        self._answers: list[Any] = []
        self.capabilities = self.answer()

    # ---- messages

    def _send(self) -> None:
        data = self.protocol.send()
        if data:
            self._to.write(data)
            self._to.flush()

    def _receive(self, until: float) -> None:
        """Take what comes next."""
        ready, _, _ = select.select([self._source], [], [], max(0.0, until - time.monotonic()))
        data = os.read(self._source.fileno(), 1 << 16) if ready else b""
        assert data, f"nothing came; events: {self.events[-5:]}"
        for item in self.protocol.receive(data):
            if isinstance(item, tuple):
                self.events.append(item)
            else:
                self._answers.append(item)

    def answer(self) -> Any:
        """Send what is waiting, and return the next answer."""
        self._send()
        until = time.monotonic() + TIMEOUT
        while not self._answers:
            self._receive(until)
        found = self._answers.pop(0)
        if isinstance(found, ErrorResponse):
            assert found.body.error is not None
            raise Failed(found.body.error.format)
        return found

    def ask(self, command: str, **arguments: Any) -> Any:
        """Ask by the name of a request."""
        self.protocol.send_request(command, arguments)
        return self.answer()

    def event(self, *names: str) -> Any:
        """Return the body of the next event of these names after those returned before."""
        until = time.monotonic() + TIMEOUT
        while True:
            for index in range(self._seen, len(self.events)):
                name, body = self.events[index]
                if name in names:
                    self._seen = index + 1
                    return body
            self._receive(until)

    # ---- a session

    def launch(self, **arguments: Any) -> None:
        """Launch a program, up to where breakpoints may be set."""
        self.ask("launch", **arguments)
        self.event("initialized")

    def start(self) -> StoppedEvent:
        """End the configuration, and wait for the first stop."""
        self.protocol.configuration_done()
        self.answer()
        return self.stopped()

    def stopped(self) -> StoppedEvent:
        """Wait for a stop."""
        return self.event("stopped")

    def move(self, command: str) -> StoppedEvent:
        """Move, and wait for the stop: ``next``, ``stepBack``, ``continue`` ..."""
        self.ask(command, threadId=1)
        return self.stopped()

    def frames(self) -> list[Any]:
        """Return the frames of the stack."""
        self.protocol.stack_trace(1)
        return list(self.answer().stackFrames)

    @property
    def line(self) -> int:
        """The line where the program stands."""
        return int(self.frames()[0].line)

    def scope(self, name: str) -> dict[str, Any]:
        """Return the variables of a scope, by the first word of their names."""
        self.protocol.scopes(1)
        found = next(item for item in self.answer().scopes if item.name.startswith(name))
        return self.children(found.variablesReference)

    def children(self, reference: int, **page: Any) -> dict[str, Any]:
        """Return the variables of a reference, by name."""
        self.protocol.variables(reference, **page)
        return {item.name: item for item in self.answer().variables}

    def value(self, expression: str, context: str = "watch") -> str:
        """Return the value of an expression."""
        self.protocol.evaluate(expression, context=context)
        return str(self.answer().result)

    def output(self, category: str) -> str:
        """Return all output of a category so far."""
        bodies = [body for name, body in self.events if name == "output"]
        texts = [body.output for body in bodies if isinstance(body, OutputEvent)]
        kinds = [body.category for body in bodies]
        return "".join(text for text, kind in zip(texts, kinds, strict=True) if kind == category)

    def disconnect(self) -> None:
        """Say that the session ends."""
        self.protocol.disconnect()
        self.answer()


@contextmanager
def adapter(folder: Path = ROOT, **launch: Any) -> Iterator[Client]:
    """Start an adapter; launch a program if there are arguments; end both cleanly."""
    process = started(folder)
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        client = Client(process.stdin, process.stdout)
        if launch:
            client.launch(**launch)
        yield client
        client.disconnect()
        assert process.wait(TIMEOUT) == 0
        assert process.stderr.read() == b""
    finally:
        end(process)


def started(folder: Path = ROOT) -> subprocess.Popen[bytes]:
    """Start an adapter as an editor does."""
    pipe = subprocess.PIPE
    command = [sys.executable, "-m", "npchip", "dap"]
    return subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, cwd=folder)


def end(process: subprocess.Popen[bytes]) -> None:
    """End an adapter that may be of a test that has failed."""
    process.kill()
    process.wait()
    for pipe in (process.stdin, process.stdout, process.stderr):
        assert pipe is not None
        with suppress(BrokenPipeError):
            pipe.close()


@contextmanager
def adapter_here(**launch: Any) -> Iterator[Client]:
    """The same with an adapter in this process, which starts sooner."""
    ends = [os.pipe(), os.pipe()]
    (source, to), (answers, out) = (
        (os.fdopen(reading, "rb"), os.fdopen(writing, "wb")) for reading, writing in ends
    )
    with source, to, answers, out:
        codes: list[int] = []
        thread = Thread(target=lambda: codes.append(Adapter(source, out).serve()))
        thread.start()
        client = Client(to, answers)
        if launch:
            client.launch(**launch)
        yield client
        client.disconnect()
        thread.join(TIMEOUT)
        assert codes == [0]
        to.close()  # the thread that reads ends too
