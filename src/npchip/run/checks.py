"""The check that a program fits a machine."""

from __future__ import annotations

from collections.abc import Iterator

from npchip.base.errors import InputError
from npchip.isa import Decoded, Isa, ir
from npchip.machine import Machine
from npchip.program.model import Program


def check_fit(program: Program, machine: Machine, isa: Isa) -> None:
    """Refuse a program that does not fit a machine.

    Raises:
        InputError: NP101 too many words, NP102 assembled for another array, NP103 an address
            outside an NP's memory.
    """
    if len(program.words) > machine.rom_words:
        over = len(program.words) - machine.rom_words
        raise InputError(
            "NP101",
            f"{program.name} has {len(program.words)} words: {over} more than the "
            f"{machine.rom_words} of the program ROM of machine {machine.name}",
        )
    if program.geometry not in {None, machine.geometry}:
        raise InputError(
            "NP102",
            f"{program.name} was assembled for {program.geometry} NPs, but machine "
            f"{machine.name} has {machine.geometry}",
            hint="assemble it for this machine: assemble(path, machine=...)",
        )
    for address, word in enumerate(program.decoded(isa)):
        for value in _fixed_addresses(word):
            if value >= machine.memory_bytes:
                place = program.place(address)
                where = f"{place.file}:{place.line}" if place else f"address {address}"
                raise InputError(
                    "NP103",
                    f"{where}: memory address {value} lies outside the {machine.memory_bytes} "
                    f"bytes of an NP of machine {machine.name}",
                )


def _fixed_addresses(decoded: Decoded | None) -> Iterator[int]:
    """Yield the NP memory addresses of a word: its operands and banks of samples."""
    if decoded is None:
        return
    for operand in map(decoded.values.get, ("a", "bank")):
        if isinstance(operand, int):
            yield operand
    for statement in decoded.form.statements:
        if isinstance(statement, ir.Effect) and statement.name == "sample":
            yield ir.constant(statement.args[1], decoded.values)
