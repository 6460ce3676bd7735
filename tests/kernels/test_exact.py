"""Compiled kernels give what SciPy gives, in the cycles that the compiler says."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from typing import Literal

import numpy as np
import pytest

from examples.kernels_page import NAMED
from npchip import Chip, assemble, load_machine
from npchip.base.errors import InputError
from npchip.kernels import Compiled, Kernel, compile_kernels, read_kernel
from npchip.program.bounds import static_view
from tests.kernels.cases import filtered, frames, named, random_kernel
from tests.support.profiles import THOROUGH


def check(
    kernels: Sequence[Kernel],
    engine: Literal["wasm", "reference"] = "wasm",
    machine: str = "default",
) -> Compiled:
    """Compile kernels and compare outputs and cycles of a run."""
    compiled = compile_kernels(kernels)
    clip = frames(1)
    result = Chip(compiled.program, machine, engine).run(clip)
    for kernel in kernels:
        found, wanted = result.outputs[kernel.name], filtered(kernel, clip)
        assert np.array_equal(found, wanted), f"{kernel}\n{compiled.text}"
    assert set(result.frame_cycles.tolist()) == {compiled.cycles[machine]}
    return compiled


@pytest.mark.parametrize("name", NAMED)
def test_a_kernel_that_has_a_name(name: str) -> None:
    check([named(name)])


@pytest.mark.long
@pytest.mark.parametrize("machine", ["default", "conservative"])
@pytest.mark.parametrize("name", ["binomial_5", "sharpen", "emboss"])
def test_both_engines_and_machines(name: str, machine: str) -> None:
    check([named(name)], "reference", machine)
    check([named(name)], "wasm", machine)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(20 if THOROUGH else 3))
def test_random_kernels(seed: int) -> None:
    """A hundred kernels each, one to three at once; those that cannot be compiled do not count."""
    source = random.Random(seed)
    count = 0
    while count < 100:
        several = source.choice([1, 1, 1, 2, 3])
        count += checked([random_kernel(source, f"k{number}") for number in range(several)])


def checked(kernels: Sequence[Kernel]) -> int:
    """Check kernels at once, or one by one where that cannot be compiled; return how many."""
    try:
        check(kernels)
    except InputError as error:
        if error.code not in {"NP532", "NP533"}:
            raise
        return sum(checked([kernel]) for kernel in kernels) if len(kernels) > 1 else 0
    return len(kernels)


@pytest.mark.parametrize(
    "names", [["sobel_x", "sobel_y"], ["binomial", "laplace"], ["prewitt_x", "prewitt_y", "box"]]
)
def test_several_at_once_take_fewer_words_and_cycles(names: list[str]) -> None:
    kernels = [named(name) for name in names]
    alone = [compile_kernels([kernel]) for kernel in kernels]
    together = check(kernels)
    assert len(together.program.words) < sum(len(one.program.words) for one in alone)
    assert together.cycles["default"] < sum(one.cycles["default"] for one in alone)


def test_the_same_as_the_program_written_by_hand_and_no_slower() -> None:
    compiled = check([named("binomial")])
    by_hand = assemble("smooth")
    result = Chip(by_hand).run(frames(1))
    assert np.array_equal(result.outputs["smooth"], filtered(named("binomial"), frames(1)))
    for machine in ("default", "conservative"):
        frame = static_view(by_hand, load_machine(machine)).frame
        assert frame is not None
        assert compiled.cycles[machine] <= 1.15 * frame.least


@pytest.mark.parametrize("name", ["binomial", "emboss", "log_5"])
def test_the_bounds_of_the_program_are_its_cycles(name: str) -> None:
    compiled = compile_kernels([named(name)])
    frame = static_view(compiled.program, load_machine("default")).frame
    assert frame is not None
    assert frame.least == frame.most == compiled.cycles["default"]


@pytest.mark.parametrize(
    ("weights", "options"),
    [
        ("0 0 0; 0 257 0; 0 0 0", {}),  # 65,535 is the largest sum
        ("0 0 0; 0 128 0; 0 0 -128", {}),  # from -32,640 to 32,640
        ("0 0 0; 0 1 0; 0 0 -255", {}),  # nearly all of them below 0
        ("0 0 0; 0 -1 0; 0 0 0", {"wrap": True}),
        ("0 0 0; 0 -1 0; 0 0 0", {"add": 255}),
        ("0 0 0; 0 1 0; 0 0 0", {"shift": 15}),
        ("0 0 0; 0 -128 0; 0 0 0", {"shift": 15, "add": 1, "down": True}),
        ("0 0 0; 0 -128 0; 0 0 3", {"shift": 8, "add": 90}),
        ("0 0 0; 0 400 0; 0 999 0", {"shift": 3, "wrap": True}),  # wraps, and may
    ],
)
def test_at_the_edges_of_the_range(weights: str, options: dict[str, int]) -> None:
    check([read_kernel(weights, "k", **options)])


def test_sums_that_16_bits_do_not_hold_are_refused() -> None:
    with pytest.raises(InputError, match=r"kernel k.*from 0 to 65,790; 16 bits") as caught:
        compile_kernels([read_kernel("0 0 0; 0 258 0; 0 0 0", "k")])
    assert caught.value.code == "NP532"


@pytest.mark.long
def test_a_program_that_does_not_fit_says_by_how_many_words() -> None:
    weights = tuple(tuple(57 + 26 * x - 31 * y * x for x in range(5)) for y in range(5))
    kernels = [
        Kernel(f"k{number}", weights[number:] + weights[:number], wrap=True, shift=8)
        for number in range(3)
    ]
    with pytest.raises(InputError, match=r"needs (\d+) words, (\d+) more than") as caught:
        compile_kernels(kernels)
    assert caught.value.code == "NP533"
    needed, missing = map(int, re.findall(r"(\d+) (?:words|more)", caught.value.message))
    assert needed - missing == 512
