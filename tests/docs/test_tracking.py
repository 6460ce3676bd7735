"""docs/tracking.md: its figures are what its script measures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from examples import tracking_page
from npchip.host.vision.truth import places_of, read_truth, score

if TYPE_CHECKING:
    from npchip.host.vision.truth import Places

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "tracking.md").read_text(encoding="utf-8")


def test_what_is_said_of_a_moving_camera() -> None:
    assert tracking_page.moving_camera() in PAGE, "python -m examples.tracking_page"


def test_the_coin_at_rest_is_where_the_truth_says() -> None:
    frames, truth = tracking_page.clip("coin_slide")
    measured, predicted = places_of(tracking_page.run("follow", frames, "as it is").outputs)
    away: list[Places] = [truth["coin"][k] - measured[k] for k in range(10, len(frames))]
    assert np.hypot(*np.transpose(away)).max() <= 0.25
    assert score(truth, measured, predicted).rms <= 3


def test_every_truth_file_belongs_to_a_bundled_clip() -> None:
    for file in (tracking_page.CLIPS / "truth").glob("*.json"):
        frames = np.load(tracking_page.CLIPS / f"{file.stem}.npy")
        for track in read_truth(file).values():
            assert max(track) < len(frames)
            places = np.array(list(track.values()))
            assert (places >= -0.5).all()
            assert (places <= np.array(frames.shape[1:]) - 0.5).all()


@pytest.mark.long
def test_the_page_is_what_its_script_measures() -> None:
    assert tracking_page.document() == PAGE


@pytest.mark.long
def test_its_pictures_are_what_its_script_draws(tmp_path: Path) -> None:
    tracking_page.pictures(tmp_path)
    for file in tmp_path.iterdir():
        assert file.name in {path.name for path in (ROOT / "docs" / "figures").iterdir()}
        assert f"(figures/{file.name})" in PAGE
