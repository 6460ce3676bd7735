"""Networks, data sets and table 3.1 of npchip.host.vision.orientation.

Quick runs train small networks on few poses. NPCHIP_PROFILE=thorough measures the whole table on
4,000 rendered poses with five seeds, which takes some minutes.
"""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy

from npchip.base.errors import InputError
from npchip.host.vision.orientation import (
    dataset,
    direct,
    eightbit,
    models,
    network,
)
from npchip.host.vision.orientation.dataset import Settings, Source
from npchip.host.vision.orientation.experiment import (
    ANGLE_ERRORS,
    DIRECT,
    EIGHT_BITS,
    THESIS_ROWS,
    Table,
    measure,
)
from npchip.host.vision.orientation.models import MODELS, rms, side_lengths, train_model
from npchip.host.vision.orientation.network import Parameters, split
from npchip.host.vision.orientation.scene import (
    CHIP,
    Floats,
    cartesian,
    project,
    spherical,
    yaw_and_pitch,
)
from tests.support.poses import data_set, parts
from tests.support.profiles import THOROUGH

# ---- data sets


@pytest.mark.parametrize("source", dataset.SOURCES)
def test_data_sets_are_what_their_settings_say(source: Source, tmp_path: Path) -> None:
    data = dataset.make(Settings(poses=40, seed=3, source=source, camera=CHIP))
    true = project(data.positions, camera=CHIP)
    error = abs(data.vertices - true).max()
    assert (error == 0) == (source == "exact")
    assert error <= {"exact": 0, "rounded": 0.5, "rendered": 5}[source]
    file = tmp_path / "data.npz"
    dataset.save(file, data)
    again = dataset.load(file)
    assert again.settings == data.settings
    assert np.array_equal(again.positions, data.positions)
    assert np.array_equal(again.vertices, data.vertices)
    assert np.array_equal(dataset.make(again.settings).vertices, data.vertices)


@pytest.mark.parametrize("change", [{"poses": 3}, {"poses": 10**6}, {"seed": -1}])
def test_settings_out_of_range(change: dict[str, Any]) -> None:
    with pytest.raises(InputError) as caught:
        replace(Settings(), **change)
    assert caught.value.code == "NP453"


# ---- networks


def test_split() -> None:
    found = split(1_000, 4)
    assert [len(part) for part in found] == [700, 150, 150]
    assert sorted(np.concatenate(found).tolist()) == list(range(1_000))
    assert not np.array_equal(found.test, split(1_000, 5).test)


@pytest.mark.parametrize("activation", ["tanh", "clamp"])
@pytest.mark.parametrize("outputs", [1, 3])
def test_the_normal_equations_are_those_of_differences(
    outputs: int, activation: network.Activation
) -> None:
    rng = np.random.default_rng(2)
    start = network.random_parameters(rng, 4, 3, outputs)
    inputs, targets = rng.uniform(-1, 1, (37, 3)), rng.uniform(-1, 1, (37, outputs))

    def wrong(flat: Floats) -> Floats:
        p = start.like(flat)
        value, _ = network.activate(inputs @ p.hidden.T + p.bias, activation)
        result: Floats = (value @ p.out.T + p.offset - targets).ravel()
        return result

    flat = start.flat()
    slopes = scipy.optimize.approx_fprime(flat, wrong, 1e-7)
    found = network._normal(start, network.Samples(inputs, targets), activation)  # noqa: SLF001 - the heart of the training
    assert found.gram == pytest.approx(slopes.T @ slopes, abs=1e-4)
    assert found.seen == pytest.approx(slopes.T @ wrong(flat), abs=1e-4)
    assert found.square == pytest.approx(wrong(flat) @ wrong(flat))
    part = found.behind(12)
    assert part.gram == pytest.approx(slopes[:, 12:].T @ slopes[:, 12:], abs=1e-4)


def test_shortened_residuals_have_the_same_squares() -> None:
    rng = np.random.default_rng(3)
    wrong, slopes = rng.normal(size=50), rng.normal(size=(50, 7))
    slopes[:, 3] = 0  # a neuron that does nothing
    normal = network._Normal(slopes.T @ slopes, slopes.T @ wrong, float(wrong @ wrong))  # noqa: SLF001 - the heart of the training
    found, turned = network._shortened(normal)  # noqa: SLF001 - the heart of the training
    assert found @ found == pytest.approx(wrong @ wrong)
    assert turned.T @ found == pytest.approx(slopes.T @ wrong, abs=1e-6)
    assert turned.T @ turned == pytest.approx(slopes.T @ slopes, abs=1e-6)
    assert turned.shape == (8, 7)


def test_training_learns_what_a_network_can_do() -> None:
    rng = np.random.default_rng(0)
    inputs = rng.uniform(-3, 5, (150, 2))
    targets = np.column_stack([np.tanh(inputs[:, 0] - 1), inputs[:, 0] * 2 - inputs[:, 1]])
    found, _ = network.train(inputs, targets, split(150, 0), neurons=6)
    error = found(inputs) - targets
    assert np.sqrt((error**2).mean()) < 0.02


def test_training_stops_when_the_validation_error_no_longer_falls() -> None:
    rng = np.random.default_rng(0)
    inputs, targets = rng.uniform(-1, 1, (60, 2)), rng.normal(size=(60, 1))
    sets = split(60, 0)
    found, steps = network.train(inputs, targets, sets, neurons=20)
    assert steps < 60
    train, validate = ((found(inputs[p]) - targets[p]) ** 2 for p in sets[:2])
    assert validate.mean() < 3  # on noise, a network that went on would be far worse
    assert train.mean() < validate.mean()


def test_limits_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network, "MOST_STEPS", 8)
    data = data_set()
    samples = network.Samples(
        data.vertices.reshape(-1, 6) / 50 - 1, spherical(data.positions)[:, :1] / 2000 - 1
    )
    rng = np.random.default_rng(1)
    start = network.random_parameters(rng, 5, 6, 1)
    limits = Parameters(*(np.full(part.shape, 0.4) for part in start))
    found = network.fit(start, samples, parts(), limits=limits).parameters
    assert abs(found.flat()).max() <= 0.4


@pytest.mark.parametrize("neurons", [0, 101])
def test_numbers_of_neurons(neurons: int) -> None:
    with pytest.raises(InputError, match="1 to 100"):
        train_model("hybrid", data_set(), parts(), neurons=neurons)


def test_without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "scipy.optimize", None)
    with pytest.raises(InputError, match="SciPy") as caught:
        train_model("ratios", data_set(), parts())
    assert "npchip[orient]" in (caught.value.hint or "")


# ---- models


@pytest.mark.parametrize("name", MODELS)
def test_targets_of_a_model_give_the_positions(name: str) -> None:
    data, model = data_set(), MODELS[name]
    targets = model.targets(data.positions, data.vertices)
    back = model.positions(targets, data.vertices, yaw_and_pitch(data.positions))
    assert back == pytest.approx(data.positions, abs=1e-6)


def test_side_lengths_begin_at_the_highlighted_vertex() -> None:
    triangle = np.array([[[0.0, 0], [3, 4], [3, 16]]])
    assert side_lengths(triangle).tolist() == [[5, 12, pytest.approx(265**0.5)]]


def test_shuffled_sides_say_nothing_about_their_order() -> None:
    data = data_set(600)
    ordered, shuffled = side_lengths(data.vertices), models.shuffled_side_lengths(data.vertices)
    assert np.array_equal(np.sort(ordered), np.sort(shuffled))
    same = (ordered == shuffled).mean(axis=0)
    assert same == pytest.approx([1 / 3] * 3, abs=0.08)


@pytest.mark.parametrize("name", ["hybrid", "ratios"])
def test_a_model_is_the_same_for_the_same_seed_and_in_its_file(name: str, tmp_path: Path) -> None:
    data = data_set()
    first, again, other = (train_model(name, data, parts(), neurons=5, seed=s) for s in (1, 1, 2))
    assert first.network.document() == again.network.document()
    assert first.network.document() != other.network.document()
    models.save(tmp_path / "model.json", first)
    loaded = models.load(tmp_path / "model.json")
    directions = yaw_and_pitch(data.positions)
    assert np.array_equal(loaded(data.vertices, directions), first(data.vertices, directions))
    assert loaded.trained["data"]["poses"] == 600


# ---- least squares


def test_least_squares_is_exact_on_exact_vertices() -> None:
    data = data_set(200, "exact")
    true = spherical(data.positions)
    found = direct.radial_distance(data.vertices, true[:, 1:])
    assert found == pytest.approx(true[:, 0], rel=1e-6)


def test_least_squares_finds_the_least_squares() -> None:
    """SciPy's scalar minimiser finds the same distance."""
    data = data_set(200, "rounded")
    angles = spherical(data.positions)[:, 1:]
    found = direct.radial_distance(data.vertices, angles)
    for number in range(0, 200, 20):
        here = slice(number, number + 1)

        def cost(radial: float, here: slice = here) -> float:
            place = cartesian(np.column_stack([[radial], angles[here]]))
            return float(((project(place) - data.vertices[here]) ** 2).sum())

        best = scipy.optimize.minimize_scalar(
            cost, bounds=(found[number] * 0.8, found[number] * 1.2), method="bounded",
            options={"xatol": 1e-3},
        )  # fmt: skip
        assert found[number] == pytest.approx(best.x, rel=1e-3)


def test_the_bias_of_key_points_matters() -> None:
    data, sets = data_set(), parts()
    inwards = direct.bias(data.vertices[sets.train], data.positions[sets.train])
    assert (inwards > 0.2).all()
    assert (inwards < 1.4).all()
    true = spherical(data.positions[sets.test])
    seen = data.vertices[sets.test]
    raw, better = (
        np.sqrt(np.mean((direct.radial_distance(seen, true[:, 1:], b) - true[:, 0]) ** 2))
        for b in (None, inwards)
    )
    assert better < 60
    assert raw > 2 * better


# ---- table 3.1


@pytest.mark.long
def test_a_small_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """All rows are there, and those with less information are worse."""
    monkeypatch.setattr(eightbit, "STARTS", 1)
    monkeypatch.setattr(network, "MOST_STEPS", 8)
    found = measure(data_set(300), seeds=1)
    document = found.document()
    names = [row["name"] for row in document["rows"]]
    assert {"constant guess", *THESIS_ROWS, DIRECT, EIGHT_BITS} <= set(names)
    assert json.loads(json.dumps(document)) == document
    hybrid = found.row("hybrid")
    assert hybrid.operations.multiplications == 60
    assert hybrid.operations.constants == 76
    assert found.row("vertices").operations.inputs == 6
    assert hybrid.total < found.row("vertices").total < found.row("constant guess").total
    for errors in ANGLE_ERRORS:
        assert found.row("hybrid", errors).total > hybrid.total


@cache
def whole_table() -> Table:
    return measure(dataset.make(Settings()), seeds=5)


@pytest.mark.skipif(not THOROUGH, reason="trains for minutes")
def test_table_3_1() -> None:
    """Bars of the thesis's table; figures of a run stand in docs/orientation.md."""
    found = whole_table()
    hybrid = found.row("hybrid", (0.0, 0.0))
    assert hybrid.total <= 80
    assert (found.row("vertices").median <= THESIS_ROWS["vertices"]).all()
    assert abs(found.row("side lengths").median[2] / THESIS_ROWS["side lengths"][2] - 1) <= 0.2
    assert found.row("constant guess").median[:2] == pytest.approx([577, 577], rel=0.05)
    assert found.row(EIGHT_BITS, (0.0, 0.0)).total <= 1.15 * hybrid.total
    assert found.row(DIRECT, (0.0, 0.0)).total <= 50
    assert 0.95 < found.row("hybrid, 10 neurons").total / hybrid.total < 1.25
    for errors in ANGLE_ERRORS:
        assert found.row("hybrid", errors).total > hybrid.total
    assert rms(np.ones((4, 3))).tolist() == [1, 1, 1]
