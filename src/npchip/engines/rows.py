"""Rows of a table of profile counters (`npchip.engines.counts`)."""

from __future__ import annotations

from typing import Final

EXECUTED: Final = 0
"""Executions."""
ACTIVE: Final = 1
"""Active NPs, summed over the executions."""
TAKEN: Final = 2
"""Executions in which a branch was taken."""
ENTERED: Final = 3
"""NPs active after an instruction that opens a masked region, summed over the executions."""
ROWS: Final = 4
"""Number of rows."""
