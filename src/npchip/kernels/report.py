"""Costs and shared sums of compiled kernels, as text."""

from __future__ import annotations

from collections.abc import Iterator

from npchip.base.columns import aligned
from npchip.kernels.compile import Compiled, compile_kernels
from npchip.kernels.model import Kernel
from npchip.kernels.sums import signed_digits


def report(compiled: Compiled) -> str:
    """Return words, cycles and shared sums; for several kernels also what each costs alone."""
    return "".join(f"{text}\n" for text in _report(compiled))


def _report(compiled: Compiled) -> Iterator[str]:
    yield from aligned(list(_costs(compiled)))
    yield ""
    yield f"plan: {compiled.plan.name}"
    yield (
        f"additions for each pixel: {compiled.plan.additions:.3g}; "
        f"{sum(map(_additions, compiled.kernels))} without sharing"
    )
    yield from (f"  {text}" for text in compiled.plan.formulas)


def _costs(compiled: Compiled) -> Iterator[list[str]]:
    yield ["kernel", "words", *(f"cycles, {name}" for name in compiled.cycles)]
    several = len(compiled.kernels) > 1
    for kernel in compiled.kernels if several else ():
        yield _row(kernel.name, compile_kernels([kernel]))
    yield _row("all at once" if several else compiled.kernels[0].name, compiled)


def _row(name: str, compiled: Compiled) -> list[str]:
    cycles = [f"{number:,}" for number in compiled.cycles.values()]
    return [name, str(len(compiled.program.words)), *cycles]


def _additions(kernel: Kernel) -> int:
    """Additions of a kernel whose signed digits are added one by one."""
    digits = [digit for row in kernel.weights for w in row for digit in signed_digits(w)]
    return len(digits) - 1
