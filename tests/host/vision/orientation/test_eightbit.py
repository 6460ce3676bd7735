"""The network in the chip's 8 bits."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.host.vision.orientation import eightbit
from npchip.host.vision.orientation.scene import CHIP, spherical
from tests.support.poses import data_set, parts


def test_half_pixel_sides_are_whole_roots() -> None:
    rng = np.random.default_rng(4)
    points = rng.integers(0, 130, (300, 3, 2))
    points[0] = 0, 0
    sides = eightbit.half_pixel_sides(points)
    for three, found in zip(points.tolist(), sides.tolist(), strict=True):
        for (row, col), (r, c), side in zip(three, [*three[1:], three[0]], found, strict=True):
            square = 4 * ((r - row) ** 2 + (c - col) ** 2)
            assert side == min(255, next(n for n in range(800) if (n + 1) ** 2 > square))


@pytest.mark.long
def test_the_network_in_8_bits(tmp_path: Path) -> None:
    data, sets = data_set(), parts()
    found = eightbit.train_chip(data, sets, neurons=6, starts=1, seed=3)
    again = eightbit.train_chip(data, sets, neurons=6, starts=1, seed=3)
    assert np.array_equal(found.hidden, again.hidden)
    assert abs(found.hidden).max() <= 63
    sides = eightbit.half_pixel_sides(np.rint(data.vertices).astype(np.int64))
    assert sides.max() <= 255
    for three, eighths in zip(sides.tolist(), found.eighths(sides).tolist(), strict=True):
        total = found.offset
        for neuron, weights in enumerate(found.hidden.tolist()):
            acc = sum(w * s for w, s in zip(weights, three, strict=True)) + int(found.bias[neuron])
            assert -(2**15) <= acc < 2**15
            total += int(found.out[neuron]) * max(0, min(255, (acc >> 4) + 128))
        assert eighths == total % 2**16
    error = found.radial(sides[sets.test]) - spherical(data.positions[sets.test])[:, 0]
    assert np.sqrt(np.mean(error**2)) < 160
    eightbit.save(tmp_path / "chip.json", found)
    loaded = eightbit.load(tmp_path / "chip.json")
    assert np.array_equal(loaded.eighths(sides), found.eighths(sides))


def test_planes() -> None:
    chip = eightbit.ChipNetwork(
        np.array([[-1, 2, 63], [-63, 0, 5]]), np.array([-2, 300]), np.array([-128 + 1, 7]), 65535,
        CHIP, {},
    )  # fmt: skip
    planes = chip.planes(1, 3)
    assert planes[:, 0].T.tolist() == [
        [255, 2, 63, 254, 255, 129, 255, 255],
        [193, 0, 5, 44, 1, 7, 0, 0],
        [0] * 8,
    ]
    with pytest.raises(InputError, match="2 neurons"):
        chip.planes(1, 1)


@pytest.mark.parametrize(
    ("hidden", "bias"), [([64, 0, 0], 0), ([63, 63, 63], 0), ([0, 0, 0], 2**15)]
)
def test_networks_that_could_overflow_are_refused(hidden: list[int], bias: int) -> None:
    with pytest.raises(ValueError, match=r"range|16 bits"):
        eightbit.ChipNetwork(np.array([hidden]), np.array([bias]), np.array([1]), 0, CHIP, {})


def test_files_that_are_no_networks(tmp_path: Path) -> None:
    file = tmp_path / "chip.json"
    good = json.loads(
        (Path(__file__).parents[4] / "examples" / "orientation" / "chip-64x80.json").read_text()
    )
    for content in (
        "",
        json.dumps(good | {"kind": "x"}),
        json.dumps(good | {"bias": [1]}),
        json.dumps(good | {"out": [1000] * 15}),
        json.dumps(good | {"hidden": [["a"] * 3] * 15}),
    ):
        file.write_text(content)
        with pytest.raises(InputError, match=r"chip\.json"):
            eightbit.load(file)
