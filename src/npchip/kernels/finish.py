"""From the sum of a kernel to the byte that is sent: constant, division, rounding, limits.

Sums are kept modulo 65,536, and only at the end it matters which numbers they stand for. All that
is needed then is that the numbers which can occur differ modulo 65,536, and that a high byte tells
negative ones from others.
"""

from __future__ import annotations

from typing import NamedTuple

from npchip.base.errors import InputError
from npchip.kernels.code import Register
from npchip.kernels.model import Kernel
from npchip.kernels.numbers import Arithmetic, Number

BITS = 1 << 16


class Finish(NamedTuple):
    """The steps from the sum of a kernel to a byte.

    Attributes:
        kernel: the kernel.
        width: bytes that its sum needs, 1 or 2.
        constant: added to the sum before the division.
        after: added after the division, with the bit that rounds.
        rounds: whether the highest bit that is cut off is added after the division.
        below: the values can be below 0 and become 0 then.
        above: the values can be above 255 and become 255 then.
        negative: high bytes from this one on mean negative numbers.
    """

    kernel: Kernel
    width: int
    constant: int = 0
    after: int = 0
    rounds: bool = False
    below: bool = False
    above: bool = False
    negative: int = 256

    @property
    def limited(self) -> bool:
        """True if some value is out of the range of a byte and has to be cut off."""
        return self.below or self.above


def finish_of(kernel: Kernel) -> Finish:
    """Decide from the range of its values how the sum of a kernel becomes a byte.

    Raises:
        InputError: NP532, the values need more than 16 bits.
    """
    shift, low, high = kernel.shift, kernel.lowest, kernel.highest
    below, above = low >> shift < 0, high >> shift > 255
    fits = kernel.wrap or not (below or above)
    if fits and not shift:
        return Finish(kernel, 1, constant=kernel.constant)
    if fits and shift <= 8:
        return Finish(kernel, 2, after=kernel.add, rounds=not kernel.down)
    if shift >= 8:
        return _from_high_byte(kernel)
    negative = max((max(high, 0) >> 8) + 1, 1 << shift)
    _check(kernel, negative <= (BITS + low) >> 8 if below else high < BITS)
    return Finish(kernel, 2, constant=kernel.constant, below=below, above=above, negative=negative)


def _from_high_byte(kernel: Kernel) -> Finish:
    """The same where the low byte is cut off whole: what is added makes all sums positive."""
    shift, half = kernel.shift, kernel.constant - (kernel.add << kernel.shift)
    low, high = kernel.lowest - kernel.constant + half, kernel.highest - kernel.constant + half
    bias = -(min(low, 0) >> shift)
    _check(kernel, high + (bias << shift) < BITS)
    after = kernel.add - bias
    limited = not kernel.wrap
    return Finish(
        kernel,
        2,
        constant=half + (bias << shift),
        after=after,
        below=limited and ((low >> shift) + kernel.add) < 0,
        above=limited and ((high >> shift) + kernel.add) > 255,
    )


def _check(kernel: Kernel, fits: bool) -> None:
    if not fits:
        raise InputError(
            "NP532",
            f"kernel {kernel.name}: its sums, with what rounds and is added, go from "
            f"{kernel.lowest:,} to {kernel.highest:,}; 16 bits do not hold them",
            hint="make the weights smaller, or divide by at most 256 and let the result --wrap",
        )


def finished(do: Arithmetic, how: Finish, number: Number, *, own: bool) -> Register:
    """Write the code that makes a byte of a sum; return its register.

    Args:
        do: where to.
        how: the way.
        number: the sum with `Finish.constant` added.
        own: whether its registers may be changed.
    """
    kernel, code = how.kernel, do.code
    if do.width == 1:
        return number.low
    if not kernel.shift and not how.limited:
        return number.low
    if not own:
        number = do.copy(number)
    number = do.widened(number)
    low, high = number.low, number.high
    assert high is not None
    if how.limited:
        return _limited(do, how, low, high)
    code.note(f"{kernel.name}: / {1 << kernel.shift}")
    lines, result = _divided(kernel.shift)
    where = (low, high)
    byte = (low, high)[result]
    add = how.after & 255
    if how.rounds:
        if kernel.shift == 8:
            lines = ["SHL {0}, #1"]  # C: the highest bit that is cut off
        lines.append(f"ADC {{{result}}}, #{add}")
    elif add:
        lines.append(f"ADD {{{result}}}, #{add}")
    if lines:
        code.add(lines, *where, changed=where)
    return byte


def _divided(shift: int) -> tuple[list[str], int]:
    """Lines that shift two bytes to one, and which of them has the result; C is what is cut off."""
    if not shift:
        return [], 0
    if shift < 8:
        return [f"SHL {{1}}, #{8 - shift}", f"SHR {{0}}, #{shift}", "OR {0}, {1}"], 0
    return [f"SHR {{1}}, #{shift - 8}"] if shift > 8 else [], 1


def _limited(do: Arithmetic, how: Finish, low: Register, high: Register) -> Register:
    """Divide, and cut off what is below 0 or above 255."""
    shift = how.kernel.shift
    do.code.note(f"{how.kernel.name}: 0 to 255")
    lines, result = _divided(shift)
    if shift >= 8:
        lines += _added(how)
    else:
        if how.below and how.above:
            limit = [f"  CMP {{1}}, #{how.negative}", "  SBC {0}, {0}"]  # positive: 255
        else:
            limit = [f"  MOV {{0}}, #{0 if how.below else 255}"]
        rest = ["ELSE", *(f"  {line}" for line in lines)] if shift else []
        lines = [f"CMP {{1}}, #{1 << shift}", "WHERE HS", *limit, *rest, "END"]
    do.code.add(lines, low, high, changed=(low, high))
    return (low, high)[result]


def _added(how: Finish) -> list[str]:
    """Lines that add a number to the high byte; where it is left, they stay at its limit."""
    if abs(how.after) > 255:
        return [f"MOV {{1}}, #{255 if how.after > 0 else 0}"]
    mnemonic, limit = ("ADD", 255) if how.after >= 0 else ("SUB", 0)
    return [f"{mnemonic} {{1}}, #{abs(how.after)}", "WHERE LO", f"  MOV {{1}}, #{limit}", "END"]
