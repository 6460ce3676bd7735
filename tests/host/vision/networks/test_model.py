"""The integer model against sums written out, and its weights as bytes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip.host.vision.networks.features import CELLS, COUNTS, EDGE, INK, NPS, cells, centred
from npchip.host.vision.networks.features import counts as counts_of
from npchip.host.vision.networks.network import (
    BIAS_STEP,
    BIAS_STEPS,
    START,
    STEPS,
    UNIT,
    bias_weights,
    from_planes,
)
from tests.asm.test_digits import random_frames, random_network


def test_a_cell_is_the_mean_of_four_pixels() -> None:
    frame = np.zeros((1, 64, 80), np.uint8)
    frame[0, 2:4, 4:6] = [[255, 255], [255, 3]]
    frame[0, 63, 79] = 63
    found = cells(frame)
    assert found[0, 1, 2] == 768 // 64 == 12
    assert found.sum() == 12


def test_what_the_frame_has_everywhere_is_taken_away() -> None:
    frame = np.full((1, 64, 80), 100, np.uint8)
    frame[0, :2, :2] = 255
    assert np.unique(cells(frame)).tolist() == [0, 15 - 6]
    assert np.unique(cells(255 - frame, dark=True)).tolist() == [0, 15 - 6]
    assert np.array_equal(np.flatnonzero(cells(255 - frame, dark=True)), [0])


@pytest.mark.parametrize(
    ("row", "col", "to"),
    [(0, 0, (15, 19)), (31, 39, (15, 19)), (15, 19, (15, 19)), (16, 20, (15, 19))],
)
def test_a_single_cell_of_ink_comes_to_the_middle(row: int, col: int, to: tuple[int, int]) -> None:
    values = np.zeros((1, *CELLS), np.int64)
    values[0, row, col] = INK
    (found,) = np.argwhere(centred(values)[0])
    middle = np.array(CELLS) / 2 - 0.5
    assert np.abs(found - middle).max() == 0.5
    assert tuple(found) in {to, (16, 19), (15, 20), (16, 20)}


@pytest.mark.parametrize("seed", range(20))
def test_ink_comes_within_half_a_cell_of_the_middle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = np.zeros((1, *CELLS), np.int64)
    height, width = rng.integers(1, 14, 2)
    row, col = rng.integers(0, CELLS[0] - height), rng.integers(0, CELLS[1] - width)
    values[0, row : row + height, col : col + width] = rng.integers(0, 16, (height, width))
    found = centred(values)[0] >= INK
    assert found.sum() == (values >= INK).sum()
    if found.any():
        away = np.argwhere(found).mean(axis=0) - (np.array(CELLS) / 2 - 0.5)
        assert np.abs(away).max() <= 0.5


def test_without_ink_nothing_moves() -> None:
    values = np.full((1, *CELLS), INK - 1)
    assert np.array_equal(centred(values), values)


def test_edges_are_counted_where_they_are() -> None:
    """A square of 8 x 8 cells in the middle: its sides are in four places."""
    frame = np.zeros((1, 64, 80), np.uint8)
    frame[0, 24:40, 32:48] = 255
    (found,) = counts_of(frame)
    for kernel, (below, right) in enumerate([(1, 0), (0, 1)]):
        inside, outside = found[2 * kernel], found[2 * kernel + 1]
        assert inside.sum() == outside.sum()
        rows, cols = np.nonzero(inside)
        assert (rows.mean() < 3.5) == bool(below)
        assert (cols.mean() < 4.5) == bool(right)
    assert found.shape == (COUNTS, *NPS)


def naive_counts(values: NDArray[np.int64]) -> NDArray[np.int64]:
    padded = np.pad(values, 1)
    found = np.zeros((COUNTS, *NPS), np.int64)
    for row in range(CELLS[0]):
        for col in range(CELLS[1]):
            (nw, n, ne), (w, _, e), (sw, s, se) = padded[row : row + 3, col : col + 3].tolist()
            sums = (
                sw + s + se - nw - n - ne,
                ne + e + se - nw - w - sw,
                e + s + se - nw - n - w,
                w + sw + s - n - ne - e,
            )
            for kernel, total in enumerate(sums):
                found[2 * kernel, row // 4, col // 4] += total >= EDGE
                found[2 * kernel + 1, row // 4, col // 4] += total <= -EDGE
    return found


@pytest.mark.parametrize("seed", range(2))
def test_the_model_is_its_definition_written_out(seed: int) -> None:
    network = random_network(seed)
    frames = random_frames(seed)[:5]
    for frame, scores in zip(frames, network.scores(frames).tolist(), strict=True):
        seen = naive_counts(centred(cells(frame[None]))[0])
        seen[:, :, 0] += START
        expected = network.bias.astype(int)
        for neuron in range(network.neurons):
            signs = np.where(network.hidden[neuron], 1, -1)
            active = max(0, int((seen * signs).sum()) // UNIT)
            expected = expected + active * network.classes[neuron].astype(int)
        assert scores == [(int(x) + 0x8000) % 0x10000 - 0x8000 for x in expected]


def test_bytes_hold_the_whole_network() -> None:
    network = random_network(3, neurons=24)
    planes = network.planes()
    assert planes.shape == (24 + STEPS + 3 + 3, *NPS)
    found = from_planes(planes)
    for name in ("hidden", "classes", "bias"):
        assert np.array_equal(getattr(found, name), getattr(network, name)), name


@pytest.mark.parametrize("count", [0, 3, STEPS + 3, STEPS + 11, 40])
def test_other_numbers_of_bytes_are_no_network(count: int) -> None:
    with pytest.raises(ValueError, match="holds no network"):
        from_planes(np.zeros((count, *NPS), np.uint8))


def test_other_counts_to_start_with_are_refused() -> None:
    planes = random_network(3).planes()
    planes[-3, 0, 1] = 1
    with pytest.raises(ValueError, match="start counting at 8"):
        from_planes(planes)


@pytest.mark.parametrize("step", [0, 1, 17, 32, 63, 64])
def test_a_bias_is_made_of_weights(step: int) -> None:
    weights = np.where(bias_weights(np.array([step]))[0], 1, -1)
    assert START * weights.sum() == BIAS_STEP * step - START * BIAS_STEPS
    assert np.ptp(weights.sum(axis=0)) <= 2
