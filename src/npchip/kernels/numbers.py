"""Arithmetic on numbers of one or two bytes, in the chip's instructions."""

from __future__ import annotations

from typing import NamedTuple

from npchip.kernels.code import Code, Register


class Number(NamedTuple):
    """A number in registers, modulo 256 or 65,536.

    Attributes:
        low: its low byte.
        high: its high byte; None where it is known to be 0, or of no interest.
    """

    low: Register
    high: Register | None = None

    @property
    def bytes(self) -> tuple[Register, ...]:
        """The registers."""
        return (self.low,) if self.high is None else (self.low, self.high)


class Arithmetic:
    """Writes sums; numbers are changed in place.

    Args:
        code: where to.
        width: bytes of a number, 1 (modulo 256) or 2.

    Attributes:
        additions: numbers added or subtracted so far.
    """

    def __init__(self, code: Code, width: int) -> None:
        self.code = code
        self.width = width
        self.additions = 0

    def byte(self, value: int) -> Register:
        """Return a new register with a constant in it."""
        register = self.code.new()
        self.code.add(f"MOV {{0}}, #{value & 255}", register, made=[register])
        return register

    def constant(self, value: int) -> Number:
        """Return a constant."""
        return Number(self.byte(value), self.byte(value >> 8) if self.width == 2 else None)

    def copy(self, number: Number) -> Number:
        """Return the same number in other registers."""
        copies = []
        for register in number.bytes:
            copies.append(self.code.new())
            self.code.add("MOV {0}, {1}", copies[-1], register, made=copies[-1:])
        return Number(*copies)

    def plus(self, number: Number, other: Number) -> Number:
        """Return number + other in the registers of number."""
        self.additions += 1
        self.code.add("ADD {0}, {1}", number.low, other.low, changed=[number.low])
        return self._high("ADC", number, other.high)

    def minus(self, number: Number, other: Number) -> Number:
        """Return number - other in the registers of number."""
        self.additions += 1
        self.code.add("SUB {0}, {1}", number.low, other.low, changed=[number.low])
        if self.width == 2 and number.high is None and other.high is None:
            high = self.code.new()
            self.code.add("SBC {0}, {0}", high, made=[high])
            return Number(number.low, high)
        return self._high("SBC", number, other.high)

    def plus_constant(self, number: Number, value: int) -> Number:
        """Return number + value in the registers of number."""
        low, high = value & 255, value >> 8 & 255
        if self.width == 1 or (not low and number.high is not None):
            register, part = (number.low, low) if self.width == 1 else (number.high, high)
            if part:
                assert register is not None
                self.code.add(f"ADD {{0}}, #{part}", register, changed=[register])
            return number
        if not value:
            return number
        self.code.add(f"ADD {{0}}, #{low}", number.low, changed=[number.low])
        return self._high("ADC", number, None, high)

    def doubled(self, number: Number, times: int) -> Number:
        """Return number * 2**times in the registers of number."""
        low, code = number.low, self.code
        if self.width == 1:
            self._shift("SHL", low, times)
            return number
        if number.high is None:
            high = code.new()
            code.add("MOV {0}, {1}", high, low, made=[high])
            if times < 8:
                self._shift("SHR", high, 8 - times)
                self._shift("SHL", low, times)
                return Number(low, high)
            number = Number(low, high)
            times -= 8
        elif times >= 8:
            code.add("MOV {0}, {1}", number.high, low, changed=[number.high])
            times -= 8
        elif times < 3:
            for _ in range(times):
                code.add("ADD {0}, {0}", low, changed=[low])
                code.add("ADC {0}, {0}", number.high, changed=[number.high])
            return number
        else:
            part = code.new()
            self._shift("SHL", number.high, times)
            code.add("MOV {0}, {1}", part, low, made=[part])
            self._shift("SHR", part, 8 - times)
            code.add("OR {0}, {1}", number.high, part, changed=[number.high])
            self._shift("SHL", low, times)
            return number
        assert number.high is not None
        self._shift("SHL", number.high, times)
        code.add("MOV {0}, #0", low, changed=[low])
        return number

    def widened(self, number: Number) -> Number:
        """Return the number with a high byte."""
        return number if number.high is not None else Number(number.low, self.byte(0))

    def _shift(self, mnemonic: str, register: Register, count: int) -> None:
        if count > 7:
            self.code.add("MOV {0}, #0", register, changed=[register])
        elif count:
            self.code.add(f"{mnemonic} {{0}}, #{count}", register, changed=[register])

    def _high(
        self, mnemonic: str, number: Number, other: Register | None, value: int = 0
    ) -> Number:
        """Complete an operation on the low bytes, which has left its carry."""
        if self.width == 1:
            return number
        high = number.high
        if high is None:
            high = self.byte(0)  # MOV keeps the carry
        if other is None:
            self.code.add(f"{mnemonic} {{0}}, #{value}", high, changed=[high])
        else:
            self.code.add(f"{mnemonic} {{0}}, {{1}}", high, other, changed=[high])
        return Number(number.low, high)
