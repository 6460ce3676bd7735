"""One mistake gives one error, and two give two: nothing follows from an error, nothing hides it.

`MISTAKES` are made in `SOURCE`, alone and in pairs. Only what `hides` names is hidden.
"""

from __future__ import annotations

from typing import NamedTuple

import pytest

from npchip.assembler import assemble_text
from npchip.assembler.diagnostics import AssemblyError

SOURCE = """\
.equ N, 3
.reg sum, r4
.output total, 1, scalar
.budget words 200
.require NP_ROWS <= 8, "reasons"
.macro plus what, times
  .if times > 1
        ADD sum, what
  .endif
        SUB sum, what
.endm
.macro only cc
        WHERE cc
.endm
.macro twice what
.again: ADD what, what
        JANY LO, .again
.endm
        MOV sum, #N
frame:  EXPOSE
        SAMPLE signal, 64
        CALL count
.ifdef N
        plus r1, N
.endif
        CMP sum, #5
        WHERE EQ
        MOV r3, #1
        ELSE
        ROW r3
        END
        OUT 1, r5
        JMP frame
count:  MOV r5, #4
.loop 4
.next:  SUB r5, #1
        twice r6
        JANY NE, .next
        only LO
less:   SUB r3, #1
        JANY NE, less
        END
.if N == 4
.elif N == 3
        .equ DEEP, 7
        WHERE HI
.endif
        MOV r7, #DEEP
        END
        RET
.macro last x
        MOV x, #0
.endm
.rept 2, k
        LD r2, [64 * k]
        plus r2, k
.endr
"""


class Mistake(NamedTuple):
    """A mistake, and the only error that it may give.

    Attributes:
        old: text that stands once in `SOURCE`.
        new: text instead.
        code: code of the error, which stands in the line where `old` begins.
    """

    old: str
    new: str
    code: str

    @property
    def line(self) -> int:
        """The line of the error."""
        assert SOURCE.count(self.old) == 1, self.old
        return SOURCE.count("\n", 0, SOURCE.index(self.old)) + 1


MISTAKES = {
    # Names that nothing defines
    "constant unknown": Mistake("#5\n", "#FIVE\n", "NP007"),
    "label unknown": Mistake("JMP frame", "JMP fraem", "NP007"),
    "local label unknown": Mistake("JANY NE, .next", "JANY NE, .nxet", "NP007"),
    "mnemonic unknown": Mistake("MOV r3, #1", "MVO r3, #1", "NP003"),
    "macro with a mask unknown": Mistake("only LO", "onyl LO", "NP003"),
    "macro unknown": Mistake("twice r6", "thrice r6", "NP003"),
    # Names defined twice
    "label twice": Mistake("count:  MOV r5, #4", "count:  frame: MOV r5, #4", "NP008"),
    "label twice, once in a mask": Mistake(
        "less:   SUB r3, #1\n        JANY NE, less",
        "frame:  SUB r3, #1\n        JANY NE, frame",
        "NP008",
    ),
    "local label twice": Mistake("        JANY LO, .again", ".again: JANY LO, .again", "NP008"),
    "constant twice": Mistake(".budget words 200", ".equ N, 4", "NP008"),
    "macro twice": Mistake(".macro last x", ".macro twice x", "NP008"),
    # Operands
    "register 16": Mistake("ROW r3", "ROW r16", "NP005"),
    "port 16": Mistake("OUT 1, r5", "OUT 16, r5", "NP006"),
    "bank 65": Mistake("signal, 64", "signal, 65", "NP006"),
    "byte 400": Mistake("MOV r5, #4", "MOV r5, #400", "NP006"),
    "more on the line": Mistake("ELSE\n", "ELSE x\n", "NP005"),
    "sign behind a wrong name": Mistake("MOV r7, #DEEP", "MVO r7, $", "NP001"),
    "sign": Mistake("#N\n", "#N $\n", "NP001"),
    # Directives
    "directive unknown": Mistake(".loop 4", ".lop 4", "NP004"),
    "output of no kind": Mistake("1, scalar", "1, sclar", "NP011"),
    "reason missing": Mistake(', "reasons"', "", "NP011"),
    # Macros and repetitions
    "argument missing": Mistake("plus r1, N", "plus r1", "NP012"),
    "in a macro": Mistake("ADD what, what", "ADD what, #256", "NP006"),
    "in a repetition": Mistake("[64 * k]", "[64 * k", "NP005"),
    "line of the macro": Mistake(".macro plus what, times", ".macro plus what, $", "NP001"),
    "line of the macro with a mask": Mistake(".macro only cc", ".macro only cc, $", "NP001"),
    "condition of a mask": Mistake(".elif N == 3", ".elif N ==", "NP009"),
    "sign in the condition of a mask": Mistake(".elif N == 3", ".elif N == 3 $", "NP001"),
    "line of the repetition": Mistake(".rept 2, k", ".rept 2, k $", "NP001"),
    "count of the repetition": Mistake(".rept 2, k", ".rept 2 3, k", "NP009"),
    "condition": Mistake(".if times > 1", ".if times >", "NP009"),
    # Blocks without an end
    "open macro": Mistake("#0\n.endm\n", "#0\n\n", "NP013"),
    "open macro above another": Mistake("SUB sum, what\n.endm\n", "SUB sum, what\n\n", "NP013"),
    "open repetition": Mistake("plus r2, k\n.endr\n", "plus r2, k\n\n", "NP013"),
    "open condition": Mistake("plus r1, N\n.endif\n", "plus r1, N\n\n", "NP013"),
    "open condition in a macro": Mistake("what\n  .endif\n", "what\n\n", "NP013"),
}
OPENERS = {
    "open macro": ".macro last",
    "open macro above another": ".macro only",  # which may not stand in it
    "open repetition": ".rept",
    "open condition": ".ifdef",
    "open condition in a macro": ".if times",
}
HIDDEN = {
    "macro unknown": {"in a macro", "local label twice"},
    "line of the macro": {"condition", "argument missing"},
    "open macro": {"macro twice", "in a repetition", "count of the repetition"},
    "open macro above another": {"open condition in a macro"},
    "open repetition": {"count of the repetition"},
    "line of the repetition": {"in a repetition"},
    "count of the repetition": {"in a repetition"},
}
"""Mistakes that hide others, since text that cannot be expanded is not looked into."""


def hides(error: str, other: str) -> bool:
    """Return whether one mistake may hide the error of another.

    Where a block that cannot be read may have held definitions, no name is called unknown.
    """
    unknown = other.endswith("unknown") and other != "directive unknown"
    if error.endswith("condition of a mask"):  # behind all instructions that are unknown
        unknown = MISTAKES[other].code == "NP007"
    lost = error in OPENERS or error.endswith("condition of a mask")
    return (lost and unknown) or other in HIDDEN.get(error, ())


def errors(*mistakes: Mistake) -> list[tuple[int, str]]:
    """Make mistakes in the source; return the line and the code of each error."""
    text = SOURCE
    for mistake in mistakes:
        text = text.replace(mistake.old, mistake.new)
    with pytest.raises(AssemblyError) as caught:
        assemble_text(text)
    return sorted((item.span.line.number, item.code) for item in caught.value.diagnostics)


def wanted(name: str) -> tuple[int, str]:
    """The error of a mistake."""
    mistake = MISTAKES[name]
    opener = OPENERS.get(name)
    line = SOURCE.count("\n", 0, SOURCE.index(opener)) + 1 if opener else mistake.line
    return line, mistake.code


def test_the_source_without_mistakes_assembles() -> None:
    assert assemble_text(SOURCE).words


@pytest.mark.parametrize("name", MISTAKES)
def test_one_mistake_gives_one_error(name: str) -> None:
    assert errors(MISTAKES[name]) == [wanted(name)]


@pytest.mark.parametrize("name", MISTAKES)
def test_two_mistakes_give_two_errors(name: str) -> None:
    one = MISTAKES[name]
    for other, two in MISTAKES.items():
        if name >= other or one.old in two.old or two.old in one.old:
            continue
        found = errors(one, two)
        expected = [wanted(n) for n, m in ((name, other), (other, name)) if not hides(m, n)]
        assert found == sorted(expected), other
