"""The programs of examples/studies are exact, and send the same on another chip."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from examples.measure import ROOT
from examples.networks_costs import KERNELS, kernels
from examples.studies.rewritten import DIFFERENCE, MULTIPLIED, UNROLLED
from examples.studies.study import FOLDER, Edit, Study, changed, cost
from npchip import Chip, assemble_text, load_machine
from npchip.assembler import AssemblyError
from npchip.isa import read_isa
from tests.oracles import blocks
from tests.support.clips import bundled_clips, synthetic_clip

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Frames = NDArray[np.uint8]

TASKS: Mapping[str, tuple[Callable[[Frames], Mapping[str, Frames]], str, str]] = {
    "pyramid": (blocks.pyramid, "ADC     low, #0", "ADD     low, #0"),
    "block_matching": (blocks.block_matching, "SBC     t, leasth", "SUB     t, leasth"),
}
"""For each program its oracle, and a piece of its source with what makes it wrong."""
SCENES = 30


def read(name: str) -> str:
    """The source of a study's program."""
    return (FOLDER / f"{name}.s").read_text(encoding="utf-8")


def chip_with(text: str) -> Chip:
    """A chip with a program that includes what those of asm/ include."""
    return Chip(assemble_text(text, include_paths=[ROOT / "asm"]))


@cache
def chip(name: str) -> Chip:
    return chip_with(read(name))


def wrong(name: str, chip: Chip, frames: Frames) -> list[str]:
    """Names of the outputs that are not those of the oracle."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted"
    expected = TASKS[name][0](frames)
    assert list(result.outputs) == list(expected)
    return [
        output
        for output, values in expected.items()
        if not np.array_equal(np.array(result.outputs[output]), values)
    ]


@pytest.mark.parametrize("clip", bundled_clips())
@pytest.mark.parametrize("name", TASKS)
def test_a_program_is_exact_on_real_clips(name: str, clip: str) -> None:
    assert not wrong(name, chip(name), bundled_clips()[clip])


@pytest.mark.parametrize("name", TASKS)
def test_a_program_is_exact_on_random_scenes(name: str) -> None:
    for seed in range(SCENES):
        assert not wrong(name, chip(name), synthetic_clip(seed)), seed


@pytest.mark.parametrize("name", TASKS)
def test_the_oracle_tells_a_wrong_program(name: str) -> None:
    _, right, spoiled = TASKS[name]
    text = read(name)
    assert text.count(right) == 1
    assert wrong(name, chip_with(text.replace(right, spoiled)), bundled_clips()["coin_slide"])


def test_every_block_of_a_scene_that_moves_is_found() -> None:
    """Blocks that stay within the frame; their sum is 0 at the true place alone."""
    scene = np.random.default_rng(2).integers(0, 256, (70, 86), np.uint8)
    at = {(y, x): scene[3 - y : 67 - y, 3 - x : 83 - x] for y in (-2, 0, 1) for x in (-1, 0, 2)}
    for (down, right), moved in at.items():
        chip("block_matching").reset()
        found = chip("block_matching").run(np.stack([scene[3:67, 3:83], moved]))
        inner = slice(1, -1)
        for name, value in (("down", down), ("right", right), ("low", 0), ("high", 0)):
            plane = np.array(found.value(name, 1))[inner, inner]
            assert (plane == value % 256).all(), (name, down, right)


@pytest.mark.parametrize(("engine", "factors"), [("wasm", 256), ("reference", 6)])
def test_the_product_of_any_two_bytes(engine: Literal["wasm", "reference"], factors: int) -> None:
    """Every first byte is a pixel of a frame; the second one grows by 51 from frame to frame."""
    isa = read_isa(FOLDER / "mul.yaml")
    text = """
        .output high, 0, picture
        .output low,  1, picture
        MOV     r2, #0
frame:  EXPOSE
        SAMPLE  signal, 0
        .rept 64, place
        LD      r0, [place]
        MOV     r1, r2
        MUL     r0, r1
        OUT     0, r0
        OUT     1, r1
        .endr
        ADD     r2, #51
        JMP     frame
"""
    machine = load_machine("default", isa.timing_classes)
    program = assemble_text(text, machine=machine, isa=isa)
    frame = np.resize(np.arange(256, dtype=np.uint8), (64, 80))
    result = Chip(program, machine, engine, isa).run(np.stack([frame] * factors))
    for number in range(factors):
        sent = [np.array(result.value(name, number), int) for name in ("high", "low")]
        assert (256 * sent[0] + sent[1] == frame.astype(int) * (51 * number % 256)).all()


@pytest.mark.long
@pytest.mark.parametrize("name", MULTIPLIED)
def test_a_program_that_multiplies_sends_the_same_in_fewer_words(name: str) -> None:
    study = MULTIPLIED[name]
    for machine, plain in zip(study.machines, ("default", "conservative"), strict=True):
        found, before = changed(study, machine), cost(study.program, plain)
        assert found.words < before.words
        assert found.mean < before.mean


@pytest.mark.parametrize("study", [DIFFERENCE, UNROLLED], ids=["absd", "1024 words"])
def test_block_matching_on_another_chip_sends_the_same_in_fewer_cycles(study: Study) -> None:
    assert changed(study, study.machines[0]).mean < cost(study.program).mean


@pytest.mark.long
@pytest.mark.parametrize("names", KERNELS, ids="+".join)
def test_kernels_in_a_larger_rom_send_the_same(names: tuple[str, ...]) -> None:
    frames = bundled_clips()["coin_slide"][:3]
    large = Chip(kernels(names, large=True).program, FOLDER / "rom_1024.yaml").run(frames)
    for number, name in enumerate(names):
        alone = Chip(kernels((name,)).program).run(frames)
        assert np.array_equal(large.outputs[name], alone.outputs[name]), number


@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_a_loop_and_a_routine_that_end_beyond_512_words(
    engine: Literal["wasm", "reference"],
) -> None:
    """Jumps from there lead back, and a call from there returns there."""
    text = """
        .output sum, 0, scalar
        JMP     start
add:    ADD     r1, #1
        RET
start:  MOV     r1, #0
        MOV     r2, #3
.loop:
        .rept 600
        NOP
        .endr
        CALL    add
        SUB     r2, #1
        JANY    NE, .loop
        OUT     0, r1
        HALT
"""
    machine = load_machine(FOLDER / "rom_1024.yaml")
    result = Chip(assemble_text(text, machine=machine), machine, engine).run()
    assert result.status == "halted"
    assert result.setup.outputs["sum"] == 3


def test_a_jump_beyond_512_words_is_refused() -> None:
    text = "        JMP     far\n        .rept 600\n        NOP\n        .endr\nfar:    HALT\n"
    with pytest.raises(AssemblyError, match="from 0 to 511, found 601"):
        assemble_text(text, machine=load_machine(FOLDER / "rom_1024.yaml"))


def test_an_edit_whose_lines_are_not_there_says_so(tmp_path: Path) -> None:
    (tmp_path / "a.s").write_text("\none\ntwo\nthree\none\n", encoding="utf-8")
    with pytest.raises(ValueError, match="2 lines begin with 'one"):
        Edit("a.s", "one\n", "two\n", "").apply(tmp_path)
    with pytest.raises(ValueError, match="no 'four\n' behind 'two\n'"):
        Edit("a.s", "two\n", "four\n", "").apply(tmp_path)
    Edit("a.s", "two\n", "three\n", "2\n").apply(tmp_path)
    assert (tmp_path / "a.s").read_text(encoding="utf-8") == "\none\n2\none\n"
