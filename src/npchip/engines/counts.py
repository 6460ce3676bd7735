"""Profile counters: executions, active NPs and taken branches, by call stack."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from npchip.engines.rows import EXECUTED, ROWS

Table = NDArray[np.int64]
"""int64, shape (4, words): rows as in `npchip.engines.rows`, a column for each address."""


@dataclass(eq=False)
class Counts:
    """The counters of a profile: one table for each call stack.

    Attributes:
        words: number of words of the program.
        tables: tables by call stack, which is the return addresses, the newest last.
    """

    words: int
    tables: dict[tuple[int, ...], Table] = field(default_factory=dict)

    def table(self, stack: tuple[int, ...]) -> Table:
        """Return the table of a call stack, and create it if needed."""
        found = self.tables.get(stack)
        if found is None:
            found = self.tables[stack] = np.zeros((ROWS, self.words), np.int64)
        return found

    def add(
        self,
        rows: Mapping[tuple[int, ...], Sequence[tuple[int, int, int, int]]],
        counters: NDArray[np.int64],
    ) -> None:
        """Add counters to the tables.

        Args:
            rows: for each call stack tuples of row, address, number of the counter, and sign.
            counters: int64, shape (counters,).
        """
        for stack, entries in rows.items():
            row, address, counter, sign = np.array(entries, np.int64).T
            np.add.at(self.table(stack), (row, address), sign * counters[counter])

    def total(self) -> Table:
        """Return the sum of all tables."""
        return sum(self.tables.values(), start=np.zeros((ROWS, self.words), np.int64))

    def used(self) -> Iterator[tuple[tuple[int, ...], Table]]:
        """Yield the call stacks that were executed, with their tables, callers first."""
        for stack in sorted(self.tables, key=lambda stack: (len(stack), stack)):
            if self.tables[stack][EXECUTED].any():
                yield stack, self.tables[stack]
