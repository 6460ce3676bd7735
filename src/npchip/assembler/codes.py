"""The assembler's codes; part of ``docs/errors.md`` is made from this list.

A code keeps its meaning for ever: scripts and ``; npchip: allow`` comments rely on it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple


class Code(NamedTuple):
    """A code, its title, and the file in ``tests/asm/errors`` that serves as its example."""

    code: str
    title: str
    example: str


CODES: Final = (
    Code("NP001", "A character that has no meaning here", "dash_from_pdf"),
    Code("NP002", "A number, character or string that cannot be read", "hex_with_h"),
    Code("NP003", "Not an instruction", "unknown_instruction"),
    Code("NP004", "Not a directive", "unknown_directive"),
    Code("NP005", "An operand that the instruction does not have", "missing_hash"),
    Code("NP006", "A number out of its range", "bank_number"),
    Code("NP007", "A name that is defined nowhere", "label_misspelt"),
    Code("NP008", "Something defined or declared twice", "label_twice"),
    Code("NP009", "An expression that is malformed", "expression_incomplete"),
    Code("NP010", "An expression without a result", "division_by_zero"),
    Code("NP011", "Arguments that a directive does not have", "output_kind"),
    Code("NP012", "Arguments that a macro does not have", "macro_arguments"),
    Code("NP013", "The begin or the end of a block is missing", "macro_unclosed"),
    Code("NP014", "Expansion without end", "macro_recursion"),
    Code("NP015", "A constant that depends on itself", "equ_cycle"),
    Code("NP016", "A value that is needed before it is known", "rept_of_label"),
    Code("NP017", "A name that cannot be defined", "name_of_register"),
    Code("NP018", "Too long for the program ROM", "words_513"),
    Code("NP019", "Longer than its own budget", "budget_words"),
    Code("NP020", "Masked regions that differ between two ways", "loop_without_end"),
    Code("NP021", "`ELSE` or `END` outside a masked region", "else_without_where"),
    Code("NP022", "Too many masked regions within each other", "masks_too_deep"),
    Code("NP023", "A routine that does not close what it opens", "ret_inside_where"),
    Code("NP024", "A source without instructions", "empty"),
    Code("NP025", "A source that cannot be read", "not_utf8"),
    Code("NP026", "`--define` of a name that is no constant", "define_unknown"),
    Code("NP027", "An included file that cannot be read", "include_missing"),
    Code("NP028", "An included file outside the allowed folders", "include_outside"),
    Code("NP029", "A file that includes itself", "include_cycle"),
    Code("NP030", "An `allow` comment that is malformed", "allow_without_reason"),
    Code("NP031", "An `.error` of the source", "error_directive"),
    Code("NP032", "A `.require` that does not hold", "require_machine"),
    Code("NP033", "A `.position` of something that is no place", "position_unknown"),
    Code("NPW01", "A label that nothing uses", "unused_label"),
    Code("NPW02", "A constant or register name that nothing uses", "unused_names"),
    Code("NPW03", "A macro that nothing uses", "unused_macro"),
    Code("NPW04", "Instructions that are never reached", "unreachable"),
    Code("NPW05", "A program that runs past its end", "past_the_end"),
    Code("NPW06", "An output that is never sent", "output_not_sent"),
    Code("NPW07", "`RET` without `CALL`", "ret_without_call"),
    Code("NPW08", "More calls within each other than the return stack holds", "calls_too_deep"),
    Code("NPW09", "An `allow` comment that allows nothing", "allow_nothing"),
    Code("NPW10", "A register or flag that is read and never written before", "never_written"),
    Code("NPW11", "A masked region that is open where the program halts", "halt_inside_where"),
    Code("NPW12", "`.loop` where no loop begins", "loop_nowhere"),
    Code("NPW13", "Frames that are taken and not sampled", "expose_without_sample"),
    Code("NPW14", "Samples without a frame", "sample_without_expose"),
)
WARNINGS: Final = frozenset(item.code for item in CODES if item.code.startswith("NPW"))


def markdown(examples: Path) -> str:
    """Return the list for ``docs/errors.md``.

    Args:
        examples: the folder of the example sources and the messages expected for them.
    """
    parts: list[str] = []
    for item in CODES:
        source = (examples / f"{item.example}.s").read_text("utf-8", errors="replace").strip("\n")
        said = (examples / f"{item.example}.expected").read_text("utf-8").strip("\n")
        lines = source.split("\n")
        if len(lines) > 20:
            source = "\n".join([*lines[:20], "..."])
        parts.append(
            f"### {item.code}: {item.title}\n\n```text\n{source}\n```\n\n```text\n{said}\n```\n"
        )
    return "\n".join(parts)
