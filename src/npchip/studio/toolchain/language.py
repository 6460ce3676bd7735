"""The language as the page's editor knows it before it sees a program."""

from __future__ import annotations

from typing import Any

from npchip.editors.rules import rules
from npchip.isa import Isa
from npchip.language.entries import entries
from npchip.machine import BUILTIN, load_machine


def language(isa: Isa) -> dict[str, Any]:
    """Return a ``Language``."""
    return {
        "entries": [{**entry._asdict(), "syntax": [*entry.syntax]} for entry in entries(isa)],
        "colours": [{"kind": rule.kind, "pattern": rule.pattern} for rule in rules(isa)],
        "machines": [{"name": name, "summary": load_machine(name).summary} for name in BUILTIN],
    }
