"""Calls of the page's compiler in CPython."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from tests.support.programs import ASM

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from npchip.studio.toolchain.facade import Toolchain


def bundled(name: str) -> dict[str, Any]:
    """A program of ``asm/`` as a project, with its golden file."""
    paths = [*sorted(ASM.glob("lib/*.s")), ASM / f"{name}.s", ASM / f"{name}.golden.json"]
    files = {path.relative_to(ASM).as_posix(): path.read_text("utf-8") for path in paths}
    return {"main": f"{name}.s", "files": files}


def request(project: dict[str, Any] | str, machine: Any = "default", **other: Any) -> Any:
    """A ``CompileRequest``; a text is a project of one file, ``program.s``."""
    if isinstance(machine, str):
        machine = {"name": machine}
    if isinstance(project, str):
        project = {"main": "program.s", "files": {"program.s": project}}
    plain: dict[str, Any] = {"defines": {}, "memory": [], "module": True}
    return {"project": project, "machine": machine, **plain, **other}


def call(toolchain: Toolchain, method: str, *arguments: Any, blobs: Sequence[bytes] = ()) -> Any:
    """Call a method of the compiler; raise its error."""
    return call_with_module(toolchain, method, *arguments, blobs=blobs)[0]


def call_with_module(
    toolchain: Toolchain, method: str, *arguments: Any, blobs: Sequence[bytes] = ()
) -> tuple[Any, bytes | None]:
    """Do what `call` does, and return the module too."""
    text, module = toolchain.call(method, json.dumps(arguments), blobs)
    answer: Mapping[str, Any] = json.loads(text)
    if "error" in answer:
        raise RefusedError(answer["error"])
    return answer["value"], module


class RefusedError(Exception):
    """An error that the page would show."""
