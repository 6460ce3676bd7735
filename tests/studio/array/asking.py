"""Questions to the page's array, and chips as it sees them."""

from __future__ import annotations

from typing import Any

import numpy as np

from npchip import Chip
from npchip.assembler.disassembler import disassemble_word
from npchip.isa import load_isa
from npchip.language.moves import moves
from npchip.program.model import Program
from tests.support.clips import CLIPS
from tests.support.page_code import Answers

ISA = load_isa()


def ask(page: Answers, name: str, **question: Any) -> Any:
    """Return the page's answer to a question."""
    return page.ask({"ask": name, **question}, plain)


def ask_alone(page: Answers, name: str, **question: Any) -> Any:
    """Return the answer of a page that was asked nothing before."""
    return page.alone({"ask": name, **question}, plain)


def plain(value: Any) -> Any:
    assert isinstance(value, np.ndarray | np.integer), value
    return value.astype(int).ravel().tolist() if isinstance(value, np.ndarray) else int(value)


def view_of(chip: Chip, **more: Any) -> dict[str, Any]:
    """A chip as the page sees it."""
    return {
        "address": chip.pc,
        "instructions": chip.instructions,
        "registers": chip.registers,
        "zero": chip.flags["Z"] * 255,
        "carry": chip.flags["C"] * 255,
        "active": chip.active,
        "memory": chip.memory,
        "exposed": chip.frame,
        **more,
    }


def info_of(program: Program) -> dict[str, Any]:
    """A program as the page sees it."""
    words = [
        {
            "text": disassemble_word(word, ISA, program.label_names),
            "origins": [{"file": item.file, "line": item.line} for item in line.origins],
            "moves": [move._asdict() for move in moves(decoded)] if decoded else [],
        }
        for word, line, decoded in zip(
            program.words, program.source, program.decoded(ISA), strict=True
        )
    ]
    named = {"labels": dict(program.labels), "registers": dict(program.registers)}
    return {**named, "words": words}


def after(program: Program, steps: int) -> Chip:
    chip = Chip(program, engine="reference")
    chip.feed(np.load(CLIPS / "shapes_photo.npy"))
    for _ in range(steps):
        chip.step()
    return chip
