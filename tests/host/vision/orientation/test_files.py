"""Files of data sets and networks: what is read, and what is refused."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.host.vision.orientation import dataset, eightbit, models, predict
from npchip.host.vision.orientation.dataset import Settings
from npchip.host.vision.orientation.models import train_model
from tests.support.poses import data_set, parts

# ---- data sets


def test_data_sets_of_older_versions_are_read(tmp_path: Path) -> None:
    """In schema 1, whole numbers were corners of pixels."""
    data = dataset.make(Settings(poses=40, source="rounded"))
    dataset.save(tmp_path / "data.npz", data)
    with np.load(tmp_path / "data.npz") as file:
        settings = str(file["settings"]).replace('"schema": 2', '"schema": 1')
    old = archive(
        settings=np.array(settings), positions=data.positions, vertices=data.vertices + 0.5
    )
    (tmp_path / "data.npz").write_bytes(old)
    assert np.array_equal(dataset.load(tmp_path / "data.npz").vertices, data.vertices)


def test_networks_of_older_versions_are_read(tmp_path: Path) -> None:
    """In schema 1, whole numbers were corners of pixels."""
    new = predict.bundled("vertices", "100x100")
    models.save(tmp_path / "v.json", new)
    document = json.loads((tmp_path / "v.json").read_text())
    document["schema"] = 1
    document["network"]["middle"] = [value + 0.5 for value in document["network"]["middle"]]
    (tmp_path / "v.json").write_text(json.dumps(document))
    seen = data_set(40).vertices
    assert models.load(tmp_path / "v.json")(seen) == pytest.approx(new(seen))


def archive(**arrays: object) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


SETTINGS = '{"schema": 1, "poses": 20, "seed": 1, "source": "exact", "camera": {}}'


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"nothing of the kind",
        archive(a=np.zeros(3)),
        archive(settings=np.array(["a", 1], object), positions=0, vertices=0),
        archive(settings=np.array(SETTINGS), positions=np.zeros((20, 3)), vertices=np.zeros(2)),
        archive(
            settings=np.array(SETTINGS),
            positions=np.full((20, 3), np.nan),
            vertices=np.zeros((20, 3, 2)),
        ),
        archive(settings=np.array(SETTINGS.replace("1", "9", 1)), positions=0, vertices=0),
        archive(settings=np.array("[1]"), positions=0, vertices=0),
    ],
)
def test_files_that_are_no_data_sets(content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "data.npz"
    file.write_bytes(content)
    with pytest.raises(InputError, match=r"data\.npz") as caught:
        dataset.load(file)
    assert caught.value.code == "NP454"


# ---- networks


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("scale", lambda _: 0),
        ("scale", lambda _: -1.0),
        ("scale", lambda _: 1e-300),
        ("target_scale", lambda _: 0.0),
        ("hidden", lambda _: float("nan")),
        ("bias", lambda _: float("inf")),
        ("out", lambda _: 1e300),
        ("middle", lambda _: 10**400),
        ("offset", lambda _: "1"),
        ("offset", lambda _: True),
        ("offset", lambda _: []),
    ],
)
def test_networks_that_no_training_gives_are_refused(
    part: str, change: Any, tmp_path: Path
) -> None:
    """Fails before: with a scale of 0, a position was NaN."""

    def changed(values: Any) -> Any:
        return [changed(value) if isinstance(value, list) else change(value) for value in values]

    models.save(tmp_path / "n.json", predict.bundled("hybrid", "100x100"))
    document = json.loads((tmp_path / "n.json").read_text())
    document["network"][part] = changed(document["network"][part])
    (tmp_path / "n.json").write_text(json.dumps(document))
    with pytest.raises(InputError, match=rf"n\.json: damaged: {part}: expected") as caught:
        models.load(tmp_path / "n.json")
    assert caught.value.code == "NP456"


def test_a_network_of_too_many_neurons_or_nested_too_deep_is_refused(tmp_path: Path) -> None:
    models.save(tmp_path / "n.json", predict.bundled("hybrid", "100x100"))
    document = json.loads((tmp_path / "n.json").read_text())
    net = document["network"]
    for part in ("hidden", "bias"):
        net[part] *= 10
    net["out"] = [net["out"][0] * 10]
    for text in (json.dumps(document), "[" * 100_000, json.dumps({**document, "network": 3})):
        (tmp_path / "n.json").write_text(text)
        with pytest.raises(InputError) as caught:
            models.load(tmp_path / "n.json")
        assert caught.value.code == "NP456"


@pytest.mark.parametrize(
    ("part", "value"),
    [
        ("offset", 1.5),
        ("offset", 10**30),
        ("offset", [1]),
        ("bias", [0.5]),
        ("out", [2**62]),
        ("hidden", [[float("nan"), 1, 2]]),
        ("hidden", [[1, 2]]),
    ],
)
def test_networks_for_the_array_are_whole_numbers(part: str, value: Any, tmp_path: Path) -> None:
    """Fails before: fractions were cut off without a word."""
    weights = {"hidden": [[1, 2, 3]], "bias": [4], "out": [5], "offset": 6}
    good = {"kind": eightbit.KIND, "schema": 1, "camera": {}, "trained": {}, **weights}
    file = tmp_path / "chip.json"
    file.write_text(json.dumps(good))
    assert eightbit.load(file).offset == 6
    file.write_text(json.dumps(good | {part: value}))
    with pytest.raises(InputError) as caught:
        eightbit.load(file)
    assert caught.value.code == "NP456"


def test_files_that_are_no_models(tmp_path: Path) -> None:
    file = tmp_path / "model.json"
    models.save(file, train_model("ratios", data_set(), parts(), neurons=2))
    good = json.loads(file.read_text())
    wrong = good["network"] | {"hidden": [[1, 2, 3]]}
    for content in (
        "",
        "[]",
        "{}",
        json.dumps(good | {"schema": 99}),
        json.dumps(good | {"model": "magic"}),
        json.dumps(good | {"model": "vertices"}),
        json.dumps(good | {"camera": {"rows": 3, "width": 2}}),
        json.dumps(good | {"camera": {"rows": "x"}}),
        json.dumps(good | {"camera": {"focal": float("nan")}}),
        json.dumps(good | {"network": wrong}),
        json.dumps(good | {"network": good["network"] | {"offset": ["x"]}}),
        json.dumps(good | {"network": good["network"] | {"offset": [float("nan")]}}),
    ):
        file.write_text(content)
        with pytest.raises(InputError, match=r"model\.json") as caught:
            models.load(file)
        assert caught.value.code == "NP456"
