"""The source of a plan: its head, its names and its lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap

from npchip.kernels.code import line
from npchip.kernels.model import Kernel
from npchip.kernels.parts import Plan


def source(plan: Plan, kernels: Sequence[Kernel], cycles: Mapping[str, int]) -> str:
    """Return the source of a program.

    Args:
        plan: the program.
        kernels: what it computes.
        cycles: cycles of a frame by machine, as far as they are known.
    """
    return "\n".join([*_head(plan, kernels, cycles), *_body(plan), ""])


def meaning(kernel: Kernel) -> str:
    """Say in a formula what a kernel makes of its sum."""
    text = "sum"
    if kernel.shift:
        half = 0 if kernel.down else 1 << (kernel.shift - 1)
        text = f"({text} + {half})" if half else text
        text = f"{text} >> {kernel.shift}"
        text = f"({text})" if kernel.add else text
    if kernel.add:
        text += f" {'+' if kernel.add > 0 else '-'} {abs(kernel.add)}"
    return f"{text}, {'modulo 256' if kernel.wrap else '0 to 255'}"


def _head(plan: Plan, kernels: Sequence[Kernel], cycles: Mapping[str, int]) -> Iterator[str]:
    names = ", ".join(kernel.name for kernel in kernels)
    yield from _comment(f"{names} - compiled by npchip kernel")
    yield ";"
    for kernel in kernels:
        widths = [max(len(str(w)) for w in column) for column in zip(*kernel.weights, strict=True)]
        for number, row in enumerate(kernel.weights):
            text = " ".join(f"{w:>{width}}" for w, width in zip(row, widths, strict=True))
            name = kernel.name if not number else ""
            yield f"; {name:<12}  {text}" + (f"    {meaning(kernel)}" if not number else "")
        yield ";"
    yield from _comment(
        "With correlated double sampling; the weights lie on the picture as they are written; "
        f"pixels outside the frame are 0. Plan: {plan.name}."
    )
    yield ";"
    for text in plan.formulas:
        yield from _comment(text)
    yield ";"
    yield from _comment(f"Words  {plan.words}")
    if cycles:
        shown = ", ".join(f"{number:,} ({name})" for name, number in cycles.items())
        yield from _comment(f"Cycles {shown} per frame")
    yield ""
    for port, kernel in enumerate(kernels):
        yield f".output {kernel.name}, {port}, picture"
    yield f".budget words {plan.words}"
    if "default" in cycles:
        yield f".budget cycles {cycles['default']}"
    yield ""
    yield f".equ SIGNAL, {plan.signal}"
    yield f".equ RESET,  {plan.reset}"
    for name, register in plan.registers.items():
        yield f".reg {name}, {register}"
    yield ""


def _body(plan: Plan) -> Iterator[str]:
    yield "; to := signal - reset of the pixel at a place, at least 0. Changes spare."
    yield ".macro cds pixel, at, spare"
    for text in ("LD pixel, [at + SIGNAL]", "LD spare, [at + RESET]", "SUB pixel, spare"):
        yield line(text)
    for text in ("WHERE LO", "  MOV pixel, #0", "END"):
        yield line(text)
    yield ".endm"
    yield ""
    yield "frame:"
    for text in ("EXPOSE", "SAMPLE reset, RESET", "SAMPLE signal, SIGNAL"):
        yield line(text)
    for section in plan.sections:
        yield from section.lines
    yield line("JMP frame")


def _comment(text: str) -> Iterator[str]:
    yield from wrap(text, 98, initial_indent="; ", subsequent_indent=";   ")
