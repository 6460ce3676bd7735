"""A command line whose run has a given result."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from npchip.cli import run
from npchip.isa import load_isa
from npchip.machine import load_machine
from tests.support.results import TRAJECTORY

if TYPE_CHECKING:
    from collections.abc import Callable

    from npchip.program.model import Program
    from npchip.run.result import RunResult


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Callable[[RunResult, Program], None]:
    """Make ``npchip run`` deliver a given result instead of assembling and executing."""

    def deliver(result: RunResult, program: Program = TRAJECTORY) -> None:
        machine = load_machine("default")
        monkeypatch.setattr(run, "load", lambda *_: (load_isa(), machine, program))
        monkeypatch.setattr(run, "execute", lambda *_: result)

    return deliver
