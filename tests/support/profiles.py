"""The chosen profile of the tests; ``tests/conftest.py`` describes the profiles."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from _pytest.mark.structures import ParameterSet

THOROUGH = os.environ.get("NPCHIP_PROFILE") == "thorough"


def parts(quick: int, long: int) -> list[ParameterSet]:
    """Number the parts of a search, so that several processes share them.

    Args:
        quick: how many parts the quick profile does.
        long: how many parts there are; the others belong to the long profile.
    """
    return [
        pytest.param(part, marks=() if part < quick else pytest.mark.long) for part in range(long)
    ]
