"""Files of breakpoints, beside the program."""

from __future__ import annotations

from pathlib import Path

import yaml

from npchip.base.errors import InputError
from npchip.base.files import write_text
from npchip.base.section import Codes, Section
from npchip.base.yaml import Located, read_mapping
from npchip.debugger.language import CommandError, parse_condition
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
    items = [
        {"stop": item.text} | ({} if item.enabled or item.error else {"enabled": False})
        for item in debugger.breakpoints.values()
    ]
    if items or path.exists():
        text = yaml.safe_dump({"breakpoints": items}, sort_keys=False, allow_unicode=True)
        write_text(path, _HEAD + text, over=True)


def load(debugger: Debugger, path: Path) -> list[str]:
    """Add the breakpoints of a file.

    Returns:
        messages on those that make no sense in this program; they are added, but disabled.

    Raises:
        InputError: NP355, not a file of breakpoints.
    """
    top = _Section(read_mapping(path, "NP355"), str(path), "a file of breakpoints")
    top.check_keys(("breakpoints",))
    items = top.data["breakpoints"] and top.get("breakpoints", list)
    if len(items or ()) > _MOST:
        raise InputError("NP355", f"{path}: {len(items)} breakpoints; at most {_MOST} are read")
    wrong = []
    for item in items or ():
        if not isinstance(item, Located):
            raise top.wrong("breakpoints", "stop: CONDITION", item)
        section = _Section(item, str(path), "a breakpoint")
        section.check_keys(("stop",), ("enabled",))
        stop, enabled = section.get("stop", str), section.get("enabled", bool, default=True)
        try:
            condition = parse_condition(stop, debugger.names, str(path), item.line)
        except CommandError as fault:
            debugger.add_broken(stop, fault.message)
            wrong.append(f"{path}:{item.line}: {fault.message}")
        else:
            debugger.add_condition(condition, enabled=enabled)
    return wrong
