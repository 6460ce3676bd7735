"""ROM images: ``$readmemh`` text for hardware tools, and raw 16-bit words, low byte first.

An image has no names, lines or budgets (decision: ``.npo`` keeps those).
"""

from __future__ import annotations

import re

from npchip.assembler import disassemble_word
from npchip.base.errors import InputError
from npchip.isa import Isa
from npchip.program.model import MAX_WORDS, Program

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_MAX_ADDRESS = 0xFFFF


def to_readmemh(program: Program, isa: Isa) -> str:
    """Return a text for Verilog's ``$readmemh``: a word a line, its instruction as a comment."""
    lines = [f"// {program.name}: {len(program.words)} words of 16 bits"]
    for address, word in enumerate(program.words):
        text = disassemble_word(word, isa) or "undefined"
        lines.append(f"{word:04X} // {address:03X}: {text}")
    return "\n".join(lines) + "\n"


def from_readmemh(text: str, file: str) -> list[int]:
    """Return the words of a ``$readmemh`` text; gaps left by ``@address`` are 0x0000, undefined.

    Raises:
        InputError: NP112 with file and line.
    """
    words: list[int] = []
    address = 0
    # Comments keep their line ends, so that lines can still be counted.
    plain = _COMMENT.sub(lambda found: "\n" * found[0].count("\n") + " ", text)
    for number, line in enumerate(plain.split("\n"), start=1):
        for item in line.split():
            digits = item.removeprefix("@").replace("_", "")
            if not re.fullmatch("[0-9a-fA-F]{1,4}", digits):
                raise InputError(
                    "NP112",
                    f"{file}:{number}: expected a word of up to four hexadecimal digits, "
                    f"found '{item[:20]}'",
                )
            value = int(digits, 16)
            if item.startswith("@"):
                address = value
                continue
            _check_size(address + 1, f"{file}:{number}")
            words.extend([0] * (address + 1 - len(words)))
            words[address] = value
            address = min(address + 1, _MAX_ADDRESS)
    return words


def to_binary(program: Program) -> bytes:
    """Return two bytes for each word, the low one first."""
    return b"".join(word.to_bytes(2, "little") for word in program.words)


def from_binary(data: bytes, file: str) -> list[int]:
    """Return the words of a raw image.

    Raises:
        InputError: NP112 an odd number of bytes.
    """
    if len(data) % 2:
        raise InputError("NP112", f"{file}: {len(data)} bytes: expected two for each word")
    _check_size(len(data) // 2, file)
    return [data[at] | data[at + 1] << 8 for at in range(0, len(data), 2)]


def _check_size(count: int, place: str) -> None:
    if count > MAX_WORDS:
        raise InputError("NP112", f"{place}: more than the {MAX_WORDS} words of any program ROM")
