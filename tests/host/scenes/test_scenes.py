"""Synthetic clips against plain geometry and mechanics, and against what a program finds."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip import Chip, assemble
from npchip.host.scenes import (
    Accelerating,
    Bouncing,
    Circular,
    Disc,
    Dot,
    Flat,
    Gradient,
    Linear,
    Motion,
    Object,
    Polygon,
    Rectangle,
    Scene,
    Shape,
    Texture,
    render,
)

ROOT = Path(__file__).parents[3]
ROWS, COLS = np.mgrid[:64, :80]


def alone(shape: Shape, motion: Motion, **settings: Any) -> Scene:
    """Make a scene of one white object before black."""
    item = Object(shape=shape, motion=motion, brightness=255)
    return Scene(objects=(item,), **({"background": Flat(level=0)} | settings))


def centroids(clip: NDArray[np.uint8]) -> NDArray[np.float64]:
    weight = clip.astype(float)
    total = weight.sum(axis=(1, 2))
    return np.stack(
        [(weight * ROWS).sum(axis=(1, 2)) / total, (weight * COLS).sum(axis=(1, 2)) / total], axis=1
    )


# --- what is drawn is where the truth says ---------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "area", "near"),
    [
        (Dot(), 1, 0.02),
        (Disc(radius=0.7), math.pi * 0.49, 0.05),
        (Disc(radius=5), math.pi * 25, 0.01),
        (Rectangle(height=3.3, width=8.1), 3.3 * 8.1, 0.04),  # pixels blur an edge by up to 1/8
        (Rectangle(height=3, width=8, angle=30, rotation=11), 24, 0.02),
        (Polygon(vertices=((0, 0), (0, 14), (10, 3)), rotation=7), 70, 0.02),
        (Polygon(vertices=((0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10))), 64, 0.02),
    ],
    ids=lambda value: type(value).__name__,
)
def test_the_centroid_and_the_area_are_those_of_the_truth(
    shape: Shape, area: float, near: float
) -> None:
    clip, truth = render(alone(shape, Linear(start=(25.2, 14.9), velocity=(0.37, 1.71))))
    np.testing.assert_allclose(centroids(clip), truth.centers[:, 0], atol=near)
    np.testing.assert_allclose(clip.sum(axis=(1, 2)) / 255, area, rtol=0.05, atol=0.05)
    assert truth.visible.all()


def test_a_whole_pixel_is_a_whole_pixel() -> None:
    clip, truth = render(alone(Dot(), Linear(start=(3, 4)), frames=1))
    assert clip[0, 3, 4] == 255
    assert clip.sum() == 255
    assert truth.boxes[0, 0].tolist() == [3, 4, 3, 4]


def test_half_a_pixel_is_half_as_bright() -> None:
    clip, truth = render(alone(Dot(), Linear(start=(3.5, 4.25)), frames=1))
    np.testing.assert_allclose(clip[0, 3:5, 4:6] / 255, [[0.375, 0.125]] * 2, atol=0.01)
    assert truth.boxes[0, 0].tolist() == [3, 4, 4, 5]


@given(
    st.floats(-20, 90),
    st.floats(-20, 100),
    st.sampled_from([Dot(), Disc(radius=6), Disc(radius=1)]),
)
def test_the_box_is_that_of_the_pixels_that_differ(row: float, col: float, shape: Shape) -> None:
    clip, truth = render(alone(shape, Linear(start=(row, col)), frames=1))
    rows, cols = np.nonzero(clip[0])
    if not len(rows):  # 1/256 of white rounds to white / 256, so nothing touched is nothing lit
        assert not truth.visible[0, 0]
        return
    expected = [rows.min(), cols.min(), rows.max(), cols.max()]
    assert truth.boxes[0, 0].tolist() == expected


def test_a_triangle_turns_clockwise_about_its_centroid() -> None:
    shape = Polygon(vertices=((0, 0), (0, 3), (6, 0)), rotation=90)
    _, truth = render(alone(shape, Linear(start=(30, 40)), frames=2))
    first, second = truth.outlines[0][0], truth.outlines[1][0]
    assert first is not None
    assert second is not None
    np.testing.assert_allclose(first, [(28, 39), (28, 42), (34, 39)])
    np.testing.assert_allclose(second, [(29, 42), (32, 42), (29, 36)], atol=1e-9)


def test_later_objects_hide_earlier_ones() -> None:
    dark = Object(shape=Disc(radius=3), motion=Linear(start=(20, 20)), brightness=40)
    light = Object(shape=Dot(), motion=Linear(start=(20, 20)), brightness=200)
    clip, truth = render(Scene(objects=(light, dark), frames=1))
    assert clip[0, 20, 20] == 40
    assert truth.visible.all()


# --- motion -------------------------------------------------------------------------------------


def path(motion: Motion, frames: int = 60, shape: Shape | None = None) -> NDArray[np.float64]:
    scene = alone(shape or Dot(), motion, frames=frames)
    return render(scene)[1].centers[:, 0]


def test_linear_and_accelerating() -> None:
    for t, place in enumerate(path(Linear(start=(1, 2), velocity=(0.5, -1)), 9)):
        assert place.tolist() == [1 + 0.5 * t, 2 - t]
    motion = Accelerating(start=(1, 2), velocity=(3, 0), acceleration=(-0.5, 0.25))
    for t, place in enumerate(path(motion, 9)):
        assert place.tolist() == [1 + 3 * t - 0.25 * t * t, 2 + 0.125 * t * t]


def test_circular() -> None:
    motion = Circular(center=(30, 40), orbit=10, period=8, phase=90)
    places = path(motion, 17)
    np.testing.assert_allclose(places[[0, 2, 4, 6]], [(40, 40), (30, 30), (20, 40), (30, 50)])
    np.testing.assert_allclose(places[:8], places[8:16], atol=1e-9)
    backwards = path(Circular(center=(30, 40), orbit=10, period=-8, phase=90), 9)
    np.testing.assert_allclose(backwards, places[8::-1], atol=1e-9)


def folded(place: float, low: float, high: float) -> float:
    """Reflect a straight line at two mirrors."""
    turn = (place - low) % (2 * (high - low))
    return low + min(turn, 2 * (high - low) - turn)


@given(st.floats(-30, 30), st.floats(-30, 30))
def test_bouncing_without_gravity_is_reflection(down: float, across: float) -> None:
    motion = Bouncing(start=(20, 30), velocity=(down, across))
    places = motion.centers(40, ((3.5, 59.5), (3.5, 75.5)))
    for t, (row, col) in enumerate(places):
        assert row == pytest.approx(folded(20 + down * t, 3.5, 59.5), abs=1e-6)
        assert col == pytest.approx(folded(30 + across * t, 3.5, 75.5), abs=1e-6)


@pytest.mark.parametrize(("gravity", "keeps"), [(0.5, 0.8), (0.3, 1.0), (2.0, 0.5), (-0.4, 0.7)])
def test_bouncing_is_what_tiny_steps_give(gravity: float, keeps: float) -> None:
    places = path(
        Bouncing(start=(10.5, 10), velocity=(0, 1.3), gravity=gravity, restitution=keeps), 50
    )
    row, speed, steps = 10.5, 0.0, 20_000
    for t in range(1, 50):
        for _ in range(steps):
            speed += gravity / steps
            row += speed / steps
            if not 0 <= row <= 63:
                row, speed = min(max(row, 0.0), 63.0), -keeps * speed
        assert places[t, 0] == pytest.approx(row, abs=0.05)


def test_the_walls_are_where_the_edge_touches_the_border() -> None:
    places = path(Bouncing(start=(20, 30), velocity=(7, 7)), 40, Disc(radius=4))
    for t, place in enumerate(places):
        expected = [folded(20 + 7 * t, 3.5, 59.5), folded(30 + 7 * t, 3.5, 75.5)]
        assert place.tolist() == pytest.approx(expected)


def test_bounce_by_hand() -> None:
    """From rest 8 above the floor with g = 1: contact at t = 4 with speed 4, up with 2."""
    places = path(Bouncing(start=(55, 10), gravity=1, restitution=0.5), 60)
    assert places[:9, 0].tolist() == [55, 55.5, 57, 59.5, 63, 61.5, 61, 61.5, 63]
    assert places[-1, 0] == 63


def test_a_ball_on_the_floor_stays_there() -> None:
    assert (path(Bouncing(start=(63, 10), gravity=0.5, restitution=0.9))[:, 0] == 63).all()


@given(
    st.floats(0, 63),
    st.floats(-1000, 1000),
    st.floats(-1000, 1000),
    st.floats(0, 1),
)
def test_nothing_leaves_the_walls(start: float, speed: float, gravity: float, keeps: float) -> None:
    motion = Bouncing(start=(start, 5), velocity=(speed, 3), gravity=gravity, restitution=keeps)
    places = motion.centers(8, ((0.0, 63.0), (0.0, 79.0)))
    assert ((places >= 0) & (places <= (63, 79))).all()


# --- camera and background ----------------------------------------------------------------------


def test_noise_has_its_rms_and_follows_the_seed() -> None:
    scene = Scene(objects=(), background=Flat(level=100), noise=4, seed=5, frames=20)
    clip = render(scene)[0].astype(float)
    assert clip.std() == pytest.approx(math.hypot(4, math.sqrt(1 / 12)), rel=0.02)
    assert clip.mean() == pytest.approx(100, abs=0.1)
    assert abs(np.corrcoef(clip[0].ravel(), clip[1].ravel())[0, 1]) < 0.05
    assert (render(scene)[0] == clip).all()
    other = render(Scene(objects=(), background=Flat(level=100), noise=4, seed=6, frames=20))[0]
    assert (other != clip).mean() > 0.8


def test_the_same_bytes_on_every_platform() -> None:
    """Pinned: a change here changes everybody's clips."""
    clip, _ = render(Scene(objects=(), background=Texture(mean=90, contrast=60), noise=3, frames=2))
    assert clip[0, :2, :6].tolist() == PINNED[0]
    assert clip[1, 40, 70:76].tolist() == PINNED[1]


PINNED: list[Any] = [
    [[87, 92, 97, 104, 102, 106], [94, 90, 92, 97, 99, 108]],
    [115, 121, 117, 113, 108, 100],
]


def test_gradient_and_texture() -> None:
    across = render(Scene(objects=(), background=Gradient(first=0, last=158), frames=1))[0][0]
    assert (across == np.arange(80) * 2).all()
    down = render(Scene(objects=(), background=Gradient(first=63, last=0, angle=90), frames=1))[0]
    assert (down[0] == 63 - ROWS).all()
    texture = Texture(mean=100, contrast=50, grain=4)
    patches = render(Scene(objects=(), background=texture, frames=1))[0][0].astype(int)
    assert patches.min() >= 75
    assert patches.max() <= 125
    assert patches.std() > 5
    assert np.abs(np.diff(patches, axis=1)).max() <= 50 / 4 + 1


def test_a_program_finds_the_disc() -> None:
    """The difference box spans two places: its centre is within 1.5 px of the middle of them."""
    clip, truth = render(
        alone(Disc(radius=5), Linear(start=(20, 10), velocity=(1.1, 2.2)), frames=25)
    )
    result = Chip(assemble(ROOT / "asm" / "trajectory.s")).run(clip)
    found = np.stack([result.outputs["center_row"], result.outputs["center_col"]], axis=1)[1:]
    middle = (truth.centers[1:, 0] + truth.centers[:-1, 0]) / 2
    assert result.outputs["valid"][1:].all()
    assert np.abs(found - middle).max() <= 1.5
