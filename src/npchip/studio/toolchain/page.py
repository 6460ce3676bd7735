"""The compiler as the page's worker calls it, in Pyodide."""

from __future__ import annotations

import json
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from npchip.machine import BUILTIN
from npchip.studio.toolchain.facade import Toolchain
from npchip.studio.toolchain.tables import Tables, from_text

TABLES: Final = "tables.json"
"""A file beside this one, which the build of the page makes."""
PROGRAM: Final = """\
; a little of everything
.equ BANK, 64
.reg sum, r1
.output total, 0, scalar
.macro add_up bank
        MOV     sum, #0
        LD      r0, [bank]
        ADD     sum, r0
        WHERE   HI
          NBR   r0, sum, north
        END
.endm
frame:  EXPOSE
        SAMPLE  reset, BANK
        SAMPLE  signal, 0
        CALL    look
        JMP     frame
look:   .rept   2, n
        add_up  BANK + n
        .endr
        CMP     sum, #9
        JANY    HI, .some
        SUB     sum, #1
.some:  OUT     0, sum
        RET
; run: dark levels=0,1
; expect: total[0] == 0
"""
"""A program with a little of everything."""


def _tables() -> Tables:
    file = files("npchip.studio.toolchain").joinpath(TABLES)
    return from_text(file.read_text("utf-8")) if file.is_file() else {}


_TABLES: Final = _tables()
_TOOLCHAIN: Final = Toolchain(Path("/project"), _TABLES)


def call(method: str, arguments: str, blobs: Iterable[Any] = ()) -> list[Any]:
    """Call a method of ``Compiler``; return the answer's JSON and its module, if it has one.

    Args:
        method: its name.
        arguments: as for `Toolchain.call`.
        blobs: as for `Toolchain.call`: arrays of JavaScript.
    """
    try:
        text, module = _TOOLCHAIN.call(method, arguments, [blob.to_bytes() for blob in blobs])
    except Exception as error:  # noqa: BLE001 - the page goes on, whatever is wrong here
        message = f"npchip failed, which is a fault of its own: {type(error).__name__}: {error}"
        return [json.dumps({"error": message}), None]
    return [text, module]


def warm() -> None:
    """Use what an edit uses, so that the first one need not wait for cold code.

    The program that was compiled last stays what it is.
    """
    toolchain = Toolchain(Path("/warm"), _TABLES)
    toolchain.call("language", "[]")
    for machine in BUILTIN:
        request = {
            "project": {"main": "warm.s", "files": {"warm.s": PROGRAM}},
            "machine": {"name": machine},
            "defines": {},
            "memory": [],
            "module": True,
        }
        toolchain.call("compile", json.dumps([request]))
        toolchain.call("tests", json.dumps([request]))
    toolchain.call("bounds", "[]")
    for condition in ("line 9", "any sum > 3", "total changes", "pixel(0,0) == 1"):
        toolchain.call("condition", json.dumps([condition]))
