"""Files of breakpoints, beside the program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from npchip.base.errors import InputError
from npchip.base.files import write_text
from npchip.base.section import Codes, Section
from npchip.base.suggest import shown
from npchip.base.yaml import Located, read_mapping
from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.moved import MARKS, followable, followed, line_at, marks, moves
from npchip.debugger.names import Names
from npchip.debugger.session import Debugger

_HEAD = "# Breakpoints; npchip debug reads and writes this file.\n"
_MOST = 1_000


class _Section(Section):
    codes = Codes("NP355", "NP355", "NP355")


def beside(program: str) -> Path:
    """Return the path of the breakpoints of a program file."""
    return Path(program).with_suffix(".breakpoints.yaml")


def save(debugger: Debugger, path: Path) -> None:
    """Write the breakpoints. Without any, empty the file if it exists.

    Raises:
        InputError: NP250, it cannot be written.
    """
    breakpoints = debugger.breakpoints.values()
    items = [
        {"stop": item.text} | ({} if item.enabled or item.error else {"enabled": False})
        for item in breakpoints
    ]
    if items or path.exists():
        document: dict[str, Any] = {"breakpoints": items}
        places = {
            item.text: _place(item.text, item.condition.places, debugger.names)
            for item in breakpoints
            if item.condition and followable(item.text, debugger.names)
        }
        if places:
            document |= {"places": places, "words": marks(debugger.program)}
        text = yaml.safe_dump(document, sort_keys=False, allow_unicode=True)
        write_text(path, _HEAD + text, over=True)


def _place(stop: str, places: frozenset[int], names: Names) -> dict[str, Any]:
    line = line_at(stop, min(places), names)
    return {"at": sorted(places)} | ({"line": line} if line else {})


def load(debugger: Debugger, path: Path) -> list[str]:
    """Add the breakpoints of a file. They follow their instructions if the program has changed.

    Returns:
        messages on those that have moved, and on those that make no sense in this program; these
        are added, but disabled.

    Raises:
        InputError: NP355, not a file of breakpoints.
    """
    top = _Section(read_mapping(path, "NP355"), str(path), "a file of breakpoints")
    top.check_keys(("breakpoints",), ("places", "words"))
    items = top.data["breakpoints"] and top.get("breakpoints", list)
    if len(items or ()) > _MOST:
        raise InputError("NP355", f"{path}: {len(items)} breakpoints; at most {_MOST} are read")
    old = top.get("words", str, default="")
    if old and not MARKS.fullmatch(old):
        raise top.wrong("words", "marks of words as npchip writes them", old)
    places = top.get("places", dict, default={})
    known = moves(old.split(), marks(debugger.program).split())
    messages = []
    for item in items or ():
        if not isinstance(item, Located):
            raise top.wrong("breakpoints", "stop: CONDITION", item)
        section = _Section(item, str(path), "a breakpoint")
        section.check_keys(("stop",), ("enabled",))
        stop, enabled = section.get("stop", str), section.get("enabled", bool, default=True)
        place = f"{path}:{item.line}"
        if old and stop in places:
            at, line = _read_place(places[stop], path)
            try:
                new = followed(stop, at, line, known, debugger.names)
            except LookupError:
                text = f": {line}" if line else ""
                messages.append(f"{place}: {stop} is another instruction now, or none{text}")
            else:
                if new != stop:
                    messages.append(f"{place}: {stop} is {new} now")
                stop = new
        try:
            condition = parse_condition(stop, debugger.names, str(path), item.line)
        except CommandError as fault:
            debugger.add_broken(stop, fault.message)
            messages.append(f"{place}: {fault.message}")
        else:
            debugger.add_condition(condition, enabled=enabled)
    return messages


def _read_place(data: Any, path: Path) -> tuple[list[Any], str]:
    if not isinstance(data, Located):
        raise InputError("NP355", f"{path}: places: expected at: [ADDRESS], found {shown(data)}")
    section = _Section(data, str(path), "a place")
    section.check_keys(("at",), ("line",))
    return section.get("at", list), section.get("line", str, default="")
