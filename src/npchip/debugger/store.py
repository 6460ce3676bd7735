"""Breakpoints beside the program: written when they change, read when a session begins."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import yaml

from npchip.base.errors import InputError
from npchip.base.files import write_bytes
from npchip.base.yaml import Located, read_mapping
from npchip.debugger.language import CommandError, parse_condition

if TYPE_CHECKING:
    from npchip.debugger.session import Debugger

_HEAD = "# Breakpoints; npchip debug reads and writes this file.\n"
_KEYS = {"stop", "enabled"}
_MOST = 1_000


def beside(program: str) -> Path:
    """Where the breakpoints of a program file are kept."""
    return Path(program).with_suffix(".breakpoints.yaml")


def save(debugger: Debugger, path: Path) -> None:
    """Write the breakpoints; without any, a file that is there is emptied and none is made.

    Raises:
        InputError: NP250, it cannot be written.
    """
    items = [
        {"stop": item.text} | ({} if item.enabled or item.error else {"enabled": False})
        for item in debugger.breakpoints.values()
    ]
    if items or path.exists():
        text = yaml.safe_dump({"breakpoints": items}, sort_keys=False, allow_unicode=True)
        write_bytes(path, (_HEAD + text).encode())


def load(debugger: Debugger, path: Path) -> list[str]:
    """Add the breakpoints of a file.

    Returns:
        What is wrong with those that mean nothing in this program; they are kept, switched off.

    Raises:
        InputError: NP355, not such a file.
    """
    data = read_mapping(path, "NP355")
    if set(data) != {"breakpoints"} or not isinstance(data["breakpoints"], list | None):
        raise InputError("NP355", f"{path}: expected one key, breakpoints, with a list")
    items = data["breakpoints"] or []
    if len(items) > _MOST:
        raise InputError("NP355", f"{path}: {len(items)} breakpoints; at most {_MOST} are read")
    wrong = []
    for item in items:
        place = f"{path}:{item.line}" if isinstance(item, Located) else str(path)
        if not isinstance(item, Located) or not isinstance(item.get("stop"), str):
            raise InputError("NP355", f"{place}: expected 'stop: CONDITION', found {item!r:.60}")
        unknown = set(item) - _KEYS
        enabled = item.get("enabled", True)
        if unknown or not isinstance(enabled, bool):
            raise InputError("NP355", f"{place}: expected stop and enabled (true or false)")
        try:
            condition = parse_condition(item["stop"], debugger.names, str(path), item.line)
        except CommandError as fault:
            debugger.add_broken(item["stop"], fault.message)
            wrong.append(f"{place}: {fault.message}")
        else:
            debugger.add_condition(condition).enabled = enabled
    return wrong
