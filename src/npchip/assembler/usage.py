"""The directives, each with its form and a line on what it does."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from npchip.program.model import OUTPUT_KINDS, OutputKind

_IF: Final = (
    ".if EXPRESSION, .elif EXPRESSION, .else, .endif",
    "assemble the first branch whose expression is not 0; the others are not read",
)
_IFDEF: Final = (
    ".ifdef NAME, .ifndef NAME, .else, .endif",
    "assemble lines if the lines above define a name, or do not",
)
_MACRO: Final = (
    ".macro NAME PARAMETER, ... to .endm",
    "names a group of lines; NAME ARGUMENT, ... assembles them",
)
_REPT: Final = (
    ".rept COUNT or .rept COUNT, NAME to .endr",
    "assembles the lines between COUNT times; NAME counts from 0",
)

_KINDS: Final[Mapping[OutputKind, str]] = {
    "scalar": "one byte",
    "scalar16": "two",
    "list": "many",
    "plane": "a byte of each NP",
    "picture": "of each pixel",
}


def _kind(name: OutputKind) -> str:
    return f"{name} ({_KINDS[name]})"


USAGE: Final[Mapping[str, tuple[str, str]]] = {
    ".equ": (
        ".equ NAME, EXPRESSION",
        "gives a number a name, such as .equ LIMIT, 128; --define changes it",
    ),
    ".reg": (".reg NAME, REGISTER", "gives a register a name, such as .reg value, r0"),
    ".output": (
        ".output NAME, PORT, KIND",
        f"names what OUT sends to a port; KIND is {', '.join(map(_kind, OUTPUT_KINDS))}",
    ),
    ".position": (
        ".position ROW, COLUMN or .position ROW, COLUMN, AHEAD",
        "says which outputs are a place, and for how many frames ahead",
    ),
    ".budget": (".budget words N or .budget cycles N", "limits the program, or its worst frame"),
    ".loop": (".loop MOST or .loop LEAST, MOST", "says for the bounds how often a loop is passed"),
    ".require": ('.require CONDITION, "REASON"', "refuses machines that the program is not for"),
    ".memory": ('.memory ADDRESS, "FILE.npy"', "puts bytes into the NPs' memories before a run"),
    ".include": ('.include "FILE"', "assembles another file at this point"),
    ".error": ('.error "TEXT"', "reports an error with your own text"),
    ".word": (".word EXPRESSION", "adds a number from 0 to 0xFFFF as a word"),
    **dict.fromkeys((".macro", ".endm"), _MACRO),
    **dict.fromkeys((".rept", ".endr"), _REPT),
    **dict.fromkeys((".if", ".elif", ".else", ".endif"), _IF),
    **dict.fromkeys((".ifdef", ".ifndef"), _IFDEF),
}
"""Form and meaning by directive; docs/assembly.md says more."""
