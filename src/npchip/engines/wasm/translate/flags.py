"""Removes the setting of flags that a block overwrites before it reads them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Final

from npchip.engines.wasm.translate.steps import Step
from npchip.isa import ir
from npchip.isa.model import Form

_BITS: Final = {"Z": 1, "C": 2}
_BOTH: Final = 3
_REGION: Final = frozenset({"mask_push", "mask_invert"})

Statements = tuple[ir.Statement, ...]


def needed(steps: Sequence[Step]) -> list[Statements]:
    """Return the statements of each step, except those that set a flag in vain.

    Args:
        steps: steps of a block that does not leave. Both flags may be read after it.
    """
    found: list[Statements] = []
    read = _BOTH
    for step in reversed(steps):
        assert step.decoded is not None
        # A write under a guard does not replace the value before it.
        statements, read = _needed(step.decoded.form, _BOTH if step.guards else read)
        found.append(statements)
    return found[::-1]


@lru_cache(4096)
def _needed(form: Form, read: int) -> tuple[Statements, int]:
    """Return the needed statements of a form, and the flags that are read from it on.

    Args:
        form: the form.
        read: the flags that are read after it.
    """
    found: list[ir.Statement] = []
    for statement in reversed(form.statements):
        if isinstance(statement, ir.SetFlag):
            bit = _BITS[statement.name]
            if not read & bit:
                continue
            read &= ~bit
        elif isinstance(statement, ir.Effect) and statement.name in _REGION:
            read = _BOTH  # a write in a masked region does not replace the value before it
        found.append(statement)
        for node in ir.walk(statement):
            if isinstance(node, ir.Flag):
                read |= _BITS[node.name]
            elif isinstance(node, ir.Condition):
                read = _BOTH
    return tuple(found[::-1]), read
