"""Rows of a table of profile counters (`npchip.engines.counts`)."""

from __future__ import annotations

from typing import Final

EXECUTED: Final = 0  # executions
ACTIVE: Final = 1  # active NPs, summed over the executions
TAKEN: Final = 2  # executions in which a branch was taken
ENTERED: Final = 3  # NPs active in the masked region that it opens, summed over the executions
ROWS: Final = 4
