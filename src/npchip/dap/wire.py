"""Messages of the protocol on a pair of pipes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO, Final

from npchip.base.errors import InputError

MOST_BYTES: Final = 16 << 20
"""Largest size of a message."""
_MOST_HEADER: Final = 4_096
_LENGTH: Final = re.compile(rb"Content-Length:[ \t]*(\d{1,20})\s*", re.IGNORECASE)

Message = dict[str, Any]
"""A message as JSON has it."""


def read(source: BinaryIO, complain: Callable[[str], None]) -> Iterator[Message]:
    """Yield messages until the input ends, also in the middle of one.

    Args:
        source: the input.
        complain: called with a sentence about what is no message, which is left out.

    Raises:
        InputError: NP359, a message that is too long to be taken into memory.
    """
    while (size := _size(source, complain)) is not None:
        if size > MOST_BYTES:
            message = f"a message of {size} bytes: at most {MOST_BYTES} are read"
            raise InputError("NP359", message, hint="is the client one for debug adapters?")
        data = source.read(size)
        if len(data) < size:
            return
        try:
            message = json.loads(data)
        except (ValueError, RecursionError) as error:
            complain(f"a message that is not JSON is left out: {error}")
            continue
        if isinstance(message, dict):
            yield message
        else:
            complain("a message that is no JSON object is left out")


def _size(source: BinaryIO, complain: Callable[[str], None]) -> int | None:
    """Read the header of a message, and return its size; None at the end of the input."""
    size, odd = None, 0
    while line := source.readline(_MOST_HEADER):
        found = _LENGTH.search(line)
        if found and found.end() == len(line):
            size = int(found[1])
            odd += found.start()
        elif line.strip():
            odd += 0 if re.match(rb"[\w-]+:", line) else len(line)
        elif size is not None:
            if odd:
                complain(f"{odd} bytes before a message are left out")
            return size
    return None


class Writer:
    """Writes messages; what cannot be written any more is dropped.

    Args:
        out: the output.

    Attributes:
        closed: whether nobody reads the output any more.
    """

    def __init__(self, out: BinaryIO) -> None:
        self._out = out
        self._count = 0
        self.closed = False

    def event(self, name: str, body: Message | None = None) -> None:
        """Send an event."""
        self._write({"type": "event", "event": name, "body": body or {}})

    def response(self, request: Message, body: Message | None = None) -> None:
        """Answer a request."""
        self._answer(request, success=True, body=body or {})

    def failure(self, request: Message, text: str, message: str | None = None) -> None:
        """Say why a request has failed.

        Args:
            request: the request.
            text: for the user.
            message: what clients know, such as ``notStopped``; by default the text.
        """
        error = {"id": request.get("seq", 0), "format": text, "showUser": True}
        self._answer(request, success=False, message=message or text, body={"error": error})

    def _answer(self, request: Message, **what: Any) -> None:
        number, command = request.get("seq", 0), request.get("command", "")
        self._write({"type": "response", "request_seq": number, "command": command, **what})

    def _write(self, message: Message) -> None:
        if self.closed:
            return
        self._count += 1
        data = json.dumps({"seq": self._count, **message}).encode()
        try:
            self._out.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
            self._out.flush()
        except (OSError, ValueError):
            self.closed = True
