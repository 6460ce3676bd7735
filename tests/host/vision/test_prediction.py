"""Prediction, motion, tracks: the equations, bits against the oracle, simulations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.host.vision import motion, tracks
from npchip.host.vision import prediction as vision
from tests.oracles import trajectory_prediction as oracle
from tests.oracles.trajectory import trajectory
from tests.support.clips import bundled_clips, synthetic_clip

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.host.vision.prediction import AxisPredictor

SIZES = st.sampled_from([64, 80, 128, 256])


@st.composite
def axes(draw: st.DrawFn) -> tuple[int, list[int]]:
    """A size and centres within it: anywhere, or near each other."""
    size = draw(SIZES)
    if draw(st.booleans()):
        return size, draw(st.lists(st.integers(0, size - 1), min_size=1, max_size=20))
    steps = draw(st.lists(st.integers(-6, 6), min_size=1, max_size=20))
    walk = np.clip(draw(st.integers(0, size - 1)) + np.cumsum(steps), 0, size - 1)
    return size, walk.tolist()


def run(predictor: AxisPredictor, centers: list[int]) -> list[list[int]]:
    return [list(map(int, predictor.update(center))) for center in centers]


# ---- equations


@given(st.integers(-500, 500), st.integers(-50, 50), st.integers(-20, 20), st.integers(1, 10))
def test_second_order_and_robust_are_exact_for_constant_acceleration(
    start: int, velocity: int, acceleration: int, steps: int
) -> None:
    def x(k: int) -> int:
        return start + velocity * k + acceleration * k * (k + 1) // 2

    assert vision.second_order(x(4), x(3), x(2), steps) == x(4 + steps)
    assert vision.robust(x(4), x(2), x(0)) == x(5)
    if not acceleration:
        assert vision.linear(x(4), x(3), steps) == x(4 + steps)


def test_the_older_displacement_belongs_with_twice_the_acceleration() -> None:
    """Displacements of 3 and 5, so 7 next: 8 + 3 + 2·2. With the newest it would be 2 too many."""
    assert vision.second_order(8, 3, 0) == 15


@given(axes(), st.integers(1, 10))
def test_second_order_is_what_the_oracle_says(axis: tuple[int, list[int]], steps: int) -> None:
    size, centers = axis
    for threshold in (1, 3, 20, 255):
        predictor = vision.SecondOrderPredictor(size, threshold, steps)
        expected = oracle.nonlinear_axis(centers, size, threshold, steps)
        assert run(predictor, centers) == expected
    never = oracle.nonlinear_axis(centers, size, 2000, steps)
    assert run(vision.SecondOrderPredictor(size, None, steps), centers) == never


@given(axes())
def test_robust_is_what_the_oracle_says(axis: tuple[int, list[int]]) -> None:
    size, centers = axis
    found = [step[0] for step in run(vision.RobustPredictor(size), centers)]
    assert found == oracle.robust_axis(centers, size)


@given(axes(), axes(), st.integers(0, 1), st.integers(0, 1), st.sampled_from([1, 2, 9]))
def test_mixed_is_what_the_oracle_says(
    rows: tuple[int, list[int]],
    cols: tuple[int, list[int]],
    axis: int,
    direction: int,
    retreat: int,
) -> None:
    size = (rows[0], cols[0])
    centers = list(zip(rows[1], cols[1], strict=False))
    predictor = vision.MixedPredictor(size, axis, direction, retreat)
    found = [predictor.update(*center) for center in centers]
    along, across = ([center[which] for center in centers] for which in (axis, 1 - axis))
    sizes = (size[axis], size[1 - axis])
    expected = oracle.mixed_axes(along, across, sizes, direction, retreat)
    for both, (ahead, beside, inflection) in zip(found, expected, strict=True):
        assert both[axis] == (ahead, bool(inflection))
        assert both[1 - axis] == (beside, False)


@given(st.lists(st.sampled_from([0, 255]), min_size=3, max_size=3))
def test_positions_stay_within_16_bits(centers: list[int]) -> None:
    x2, x1, x0 = centers
    assert -(2**15) <= vision.second_order(x0, x1, x2, vision.MAX_STEPS) < 2**15


def test_too_many_steps_would_leave_16_bits() -> None:
    assert vision.second_order(255, 0, 255, vision.MAX_STEPS + 1) >= 2**15


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: vision.LinearPredictor(0), "size"),
        (lambda: vision.RobustPredictor(257), "size"),
        (lambda: vision.SecondOrderPredictor(80, 0), "threshold"),
        (lambda: vision.SecondOrderPredictor(80, 3, 11), "steps"),
        (lambda: vision.MixedPredictor(axis=2), "axis"),
    ],
)
def test_what_a_predictor_does_not_take(make: type, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


# ---- clips


def clips() -> list[NDArray[np.uint8]]:
    return [*bundled_clips().values(), *(synthetic_clip(seed, frames=9) for seed in range(60))]


def test_outputs_and_picture_of_clips_are_what_the_oracle_says() -> None:
    for frames in clips():
        sent = vision.outputs(frames, vision.second_order_predictor())
        assert sent == oracle.trajectory_nonlinear(frames)
        picture = oracle.nonlinear_picture(frames, sent)
        np.testing.assert_array_equal(vision.marked(frames, sent), picture)
        sent = vision.outputs(frames, vision.robust_predictor())
        assert not any(sent.pop("inflection"))
        assert sent == oracle.trajectory_robust(frames)
        sent = vision.outputs(frames, vision.linear_predictor())
        assert not any(sent.pop("inflection"))
        assert sent == trajectory(frames, 32)
        for axis in (0, 1):
            sent = vision.outputs(frames, vision.MixedPredictor(axis=axis, direction=1))
            expected = oracle.trajectory_mixed(frames, axis=axis, direction=1)
            assert [min(turn, 1) for turn in sent.pop("inflection")] == expected.pop("inflection")
            assert sent == expected


def test_a_clip_without_frames() -> None:
    assert vision.moving_centers(np.empty((0, 64, 80), np.uint8)) == []


# ---- simulation


@pytest.mark.parametrize("name", motion.MOTIONS)
def test_paths_stay_inside_and_depend_on_the_seed_alone(name: str) -> None:
    make = motion.MOTIONS[name]
    for seed in range(30):
        path = make(np.random.default_rng(seed))
        again = make(np.random.default_rng(seed))
        np.testing.assert_array_equal(path.centers, again.centers)
        assert 8 <= len(path.centers) == len(path.impacts) <= 24
        assert (path.centers >= motion.MARGIN).all()
        assert (path.centers <= np.array(vision.FRAME) - 1 - motion.MARGIN + 1e-9).all()
        assert path.impacts.any() == (name == "bouncing")


def test_impacts_are_where_the_acceleration_is_not_gravity() -> None:
    path = motion.bouncing(np.random.default_rng(3), gravity=(0.5, 0.5))
    a = np.diff(path.centers[:, 0], 2)
    touched = path.impacts[2:] | path.impacts[1:-1]
    np.testing.assert_allclose(a[~touched], 0.5)
    assert (np.abs(a[touched] - 0.5) > 0.1).all()


def test_a_ball_comes_to_rest_on_the_ground() -> None:
    path = motion.bouncing(np.random.default_rng(0), frames=200, restitution=(0, 0))
    assert path.centers[-1, 0] == 64 - 1 - motion.MARGIN


def test_a_frame_too_small_for_any_path() -> None:
    with pytest.raises(ValueError, match="no such path"):
        motion.uniform(np.random.default_rng(0), frames=7)


@pytest.mark.long
def test_the_error_table_is_that_of_the_prototypes() -> None:
    """Within 8 % of the project's prototypes, whose geometry was fitted too."""
    table = tracks.error_table(paths=100)
    assert list(table) == list(motion.MOTIONS)
    for name, first, second in [
        ("linear", 0.71, 1.30),
        ("|a| 0.05–0.3", 0.73, 1.29),
        ("|a| = 1", 1.23, 1.28),
        ("|a| = 2", 2.12, 1.28),
        ("circular", 1.40, 1.36),
        ("bouncing", 2.52, 3.34),
    ]:
        assert table[name]["first order"] == pytest.approx(first, rel=0.08)
        assert table[name]["second order"] == pytest.approx(second, rel=0.08)
    for name in (name for name in table if name.startswith(("linear", "|a|"))):
        assert 0.6 < table[name]["two-frame baseline"] <= 0.85


def test_inflections_tell_impacts() -> None:
    rng = np.random.default_rng(1)
    paths = [motion.bouncing(rng) for _ in range(150)]

    def score(threshold: int | None) -> tracks.InflectionScore:
        return tracks.inflection_score(
            [
                tracks.follow(path, vision.second_order_predictor(threshold=threshold))
                for path in paths
            ]
        )

    never, three, five = score(None), score(3), score(5)
    assert never[:3] == (0, 0, 0)
    assert three.found >= 0.95
    assert 0.05 < three.suppressed < 0.12
    assert three.rms < 0.7 * never.rms
    assert five.false_alarms == 0


def test_discs_are_lit_where_the_path_is() -> None:
    path = motion.circular(np.random.default_rng(5))
    frames = motion.discs(path)
    light = frames.astype(float) - 30
    middle = np.stack(
        [
            (light.sum(axis=2) * np.arange(64)).sum(axis=1) / light.sum(axis=(1, 2)),
            (light.sum(axis=1) * np.arange(80)).sum(axis=1) / light.sum(axis=(1, 2)),
        ],
        axis=1,
    )
    np.testing.assert_allclose(middle, path.centers, atol=0.05)
