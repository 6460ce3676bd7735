"""Signals at random moments: `tests/signals.py` on a few commands."""

from __future__ import annotations

import sys

import pytest

from tests.signals import COMMANDS, failures


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix matter")
@pytest.mark.parametrize("index", range(0, len(COMMANDS), 3))
def test_signals_at_random_moments_leave_nothing_behind(index: int) -> None:
    found = failures([COMMANDS[index]], 2, seed=index)
    # The first lines must run before signals are seen to: a few thousandths of a second.
    assert [line for line in found if "exit code -" not in line] == []
