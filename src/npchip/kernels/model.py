"""A convolution kernel, how its sum becomes a byte, and the text that it is written in."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from npchip.base.errors import InputError

LARGEST_WEIGHT = 32_767
LARGEST_SHIFT = 15
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_EXAMPLE = "such as '1 2 1; 2 4 2; 1 2 1'"


@dataclass(frozen=True)
class Kernel:
    """A kernel and the byte made of its sum: ((sum + half) >> shift) + add.

    The weights lie on the picture as they are written (a correlation); pixels outside the frame
    are 0.

    Attributes:
        name: name of its output.
        weights: rows of weights, 3 x 3 or 5 x 5.
        shift: the divisor is 2**shift, 0 to 15.
        add: added to the quotient, -255 to 255.
        wrap: keep the lowest eight bits; else values below 0 become 0, above 255 become 255.
        down: round down; else to the nearest, halves up.
    """

    name: str
    weights: tuple[tuple[int, ...], ...]
    shift: int = 0
    add: int = 0
    wrap: bool = False
    down: bool = False

    @property
    def size(self) -> int:
        """Rows, and columns."""
        return len(self.weights)

    def placed(self) -> Iterator[tuple[int, int, int]]:
        """Yield distance to the south, distance to the east, and weight."""
        middle = self.size // 2
        for y, row in enumerate(self.weights):
            for x, weight in enumerate(row):
                yield y - middle, x - middle, weight

    @property
    def constant(self) -> int:
        """The number that is added to the sum before it is shifted."""
        half = 1 << (self.shift - 1) if self.shift and not self.down else 0
        return (self.add << self.shift) + half

    @property
    def lowest(self) -> int:
        """The lowest value of sum + constant."""
        return 255 * sum(min(w, 0) for row in self.weights for w in row) + self.constant

    @property
    def highest(self) -> int:
        """The highest value of sum + constant."""
        return 255 * sum(max(w, 0) for row in self.weights for w in row) + self.constant


def read_kernel(text: str, name: str, **options: int) -> Kernel:
    """Read rows of whole numbers, the rows separated by ``;``.

    Args:
        text: the rows; numbers are separated by blanks or commas.
        name: name of the output.
        options: other attributes of `Kernel`.

    Raises:
        InputError: NP530, the text is no kernel, or a value is out of its range.
    """
    if not _NAME.fullmatch(name):
        raise InputError(
            "NP530",
            f"kernel name '{name}': expected letters, digits and _, a letter first",
            hint="the name becomes that of an output",
        )
    rows = [re.split(r"[\s,]+", row.strip()) for row in text.split(";")]
    weights = tuple(tuple(_weight(cell, name) for cell in row if cell) for row in rows)
    if len(rows) not in {3, 5} or any(len(row) != len(rows) for row in weights):
        sizes = ", ".join(str(len(row)) for row in weights)
        raise InputError(
            "NP530",
            f"kernel {name}: expected 3 rows of 3 numbers or 5 rows of 5, found rows of {sizes}",
            hint=f"{_EXAMPLE}; fill a smaller kernel up with zeros",
        )
    if not any(weight for row in weights for weight in row):
        raise InputError("NP530", f"kernel {name}: all weights are 0", hint=_EXAMPLE)
    if abs(options.get("add", 0)) > 255:
        raise InputError("NP530", f"kernel {name}: --add {options['add']}: expected -255 to 255")
    return Kernel(name, weights, **options)  # type: ignore[arg-type]


def _weight(cell: str, name: str) -> int:
    if not re.fullmatch(r"[+-]?\d{1,6}", cell, re.ASCII) or abs(int(cell)) > LARGEST_WEIGHT:
        raise InputError(
            "NP530",
            f"kernel {name}: expected a whole number from -{LARGEST_WEIGHT} to {LARGEST_WEIGHT}, "
            f"found '{cell}'",
            hint="write fractions as whole numbers and --divide by a power of two",
        )
    return int(cell)


def shift_of(divisor: int) -> int:
    """The shift that divides by a number.

    Raises:
        InputError: NP531, it is no power of two from 1 to 2**15.
    """
    shift = divisor.bit_length() - 1
    if divisor < 1 or divisor != 1 << shift or shift > LARGEST_SHIFT:
        near = [
            1 << max(0, min(LARGEST_SHIFT, max(divisor, 1).bit_length() - back)) for back in (1, 0)
        ]
        raise InputError(
            "NP531",
            f"--divide {divisor}: expected a power of two from 1 to {1 << LARGEST_SHIFT}",
            hint=f"scale the weights so that {near[0]} or {near[1]} divides their sum",
        )
    return shift
