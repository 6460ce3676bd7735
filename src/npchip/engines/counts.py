"""What is counted on request besides executions: branches, active NPs, and who called."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

EXECUTED: Final = 0
"""Row of a table: executions."""
ACTIVE: Final = 1
"""NPs that were active, summed over the executions."""
TAKEN: Final = 2
"""Executions of a branch that left the way of the addresses."""
ENTERED: Final = 3
"""NPs that were active behind an instruction that opens a masked region, summed."""
_ROWS: Final = 4

Table = NDArray[np.int64]
"""int64, shape (4, words): the rows above, a column for each address."""


@dataclass(eq=False)
class Counts:
    """A table for each way in which a program can stand inside its calls.

    Attributes:
        words: words of the program.
        tables: by the return addresses, the newest last.
    """

    words: int
    tables: dict[tuple[int, ...], Table] = field(default_factory=dict)

    def table(self, stack: tuple[int, ...]) -> Table:
        """The table of a call stack, made where it is missing."""
        found = self.tables.get(stack)
        if found is None:
            found = self.tables[stack] = np.zeros((_ROWS, self.words), np.int64)
        return found

    def total(self) -> Table:
        """The sum of all tables."""
        total = np.zeros((_ROWS, self.words), np.int64)
        for table in self.tables.values():
            total += table
        return total

    def used(self) -> Iterator[tuple[tuple[int, ...], Table]]:
        """Call stacks with executions, callers before those that they call."""
        for stack in sorted(self.tables, key=lambda stack: (len(stack), stack)):
            if self.tables[stack][EXECUTED].any():
                yield stack, self.tables[stack]
