"""Files of breakpoints, beside the program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from npchip.base.errors import InputError
from npchip.base.files import write_text
from npchip.base.section import Codes, Section
from npchip.base.yaml import Located, read_mapping
from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.moved import MARKS, followable, followed, line_at, marks, moves
from npchip.debugger.session import Breakpoint, Debugger

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
    items = [_item(item, debugger) for item in debugger.breakpoints.values()]
    if items or path.exists():
        document: dict[str, Any] = {"breakpoints": items}
        if any("at" in item for item in items):
            document["words"] = marks(debugger.program)
        text = yaml.safe_dump(document, sort_keys=False, allow_unicode=True)
        write_text(path, _HEAD + text, over=True)


def _item(item: Breakpoint, debugger: Debugger) -> dict[str, Any]:
    saved: dict[str, Any] = {"stop": item.text}
    if item.condition and followable(item.text, debugger.names):
        saved["at"] = sorted(item.condition.places)
        line = line_at(item.text, min(item.condition.places), debugger.names)
        saved |= {"line": line} if line else {}
    return saved if item.enabled or item.error else saved | {"enabled": False}


def load(debugger: Debugger, path: Path) -> list[str]:
    """Add the breakpoints of a file. They follow their instructions if the program has changed.

    Returns:
        messages on those that have moved, and on those that make no sense in this program; these
        are added, but disabled.

    Raises:
        InputError: NP355, not a file of breakpoints.
    """
    top = _Section(read_mapping(path, "NP355"), str(path), "a file of breakpoints")
    top.check_keys(("breakpoints",), ("words",))
    items = top.data["breakpoints"] and top.get("breakpoints", list)
    if len(items or ()) > _MOST:
        raise InputError("NP355", f"{path}: {len(items)} breakpoints; at most {_MOST} are read")
    old = top.get("words", str, default="")
    if old and not MARKS.fullmatch(old):
        raise top.wrong("words", "marks of words as npchip writes them", old)
    known = moves(old.split(), marks(debugger.program).split())
    messages = []
    for item in items or ():
        if not isinstance(item, Located):
            raise top.wrong("breakpoints", "stop: CONDITION", item)
        section = _Section(item, str(path), "a breakpoint")
        section.check_keys(("stop",), ("at", "line", "enabled"))
        stop, enabled = section.get("stop", str), section.get("enabled", bool, default=True)
        at, line = section.get("at", list, default=[]), section.get("line", str, default="")
        place = f"{path}:{item.line}"
        if at and old:
            try:
                new = followed(stop, at, line, known, debugger.names)
            except LookupError:
                shown = f": {line}" if line else ""
                messages.append(f"{place}: {stop} is another instruction now, or none{shown}")
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
