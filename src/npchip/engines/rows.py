"""Rows of a table of profile counters (`npchip.engines.counts`)."""

from __future__ import annotations

from typing import Final

EXECUTED: Final = 0
"""Executions."""
ACTIVE: Final = 1
"""NPs that were active, summed over the executions."""
TAKEN: Final = 2
"""Executions of a branch that left the way of the addresses."""
ENTERED: Final = 3
"""NPs that were active behind an instruction that opens a masked region, summed."""
ROWS: Final = 4
"""How many there are."""
