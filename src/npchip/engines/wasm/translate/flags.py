"""Flags that are overwritten before anybody reads them: within a block nobody need compute them.

Nearly every instruction sets both flags, and few are read. What is not computed costs the
translation no time; in the module it would not be in any case.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from npchip.engines.wasm.translate.steps import Step
from npchip.isa import ir
from npchip.isa.model import Form

_BITS: Final = {"Z": 1, "C": 2}
_BOTH: Final = 3
_BEGIN: Final = frozenset({"mask_push", "mask_invert"})

_Statements = tuple[ir.Statement, ...]


class Flags:
    """Finds the statements of steps that anybody needs."""

    def __init__(self) -> None:
        self._forms: dict[tuple[int, int], tuple[_Statements, int]] = {}

    def needed(self, steps: Sequence[Step]) -> list[_Statements]:
        """The statements of each step, less those that set a flag in vain.

        Args:
            steps: of a block that does not leave; behind it both flags may be read.
        """
        found: list[_Statements] = []
        read = _BOTH
        for step in reversed(steps):
            assert step.decoded is not None
            # What is written under a guard does not replace what was there.
            statements, read = self._of(step.decoded.form, _BOTH if step.guards else read)
            found.append(statements)
        return found[::-1]

    def _of(self, form: Form, read: int) -> tuple[_Statements, int]:
        """The statements of a form behind which some flags are read, and the flags it reads."""
        key = id(form), read
        known = self._forms.get(key)
        if known is None:
            known = self._forms[key] = _needed(form, read)
        return known


def _needed(form: Form, read: int) -> tuple[_Statements, int]:
    found: list[ir.Statement] = []
    for statement in reversed(form.statements):
        if isinstance(statement, ir.SetFlag):
            bit = _BITS[statement.name]
            if not read & bit:
                continue
            read &= ~bit
        elif isinstance(statement, ir.Effect) and statement.name in _BEGIN:
            read = _BOTH  # what is written in a masked region does not replace what was there
        found.append(statement)
        for node in ir.walk(statement):
            if isinstance(node, ir.Flag):
                read |= _BITS[node.name]
            elif isinstance(node, ir.Condition):
                read = _BOTH
    return tuple(found[::-1]), read
