"""docs/figures: drawings are vectors, small, shown by a page, and the same on every day."""

from __future__ import annotations

import re
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np
import pytest

from examples.measure import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FOLDER = ROOT / "docs" / "figures"
FIGURES = sorted(path.name for path in FOLDER.iterdir())
PAGES = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md"))
PICTURES = {  # of pixels: renders of a triangle, clips
    "figure-3.8.png",
    "figure-3.9.png",
    "figure-3.14.png",
    "follow-mouse_run.png",
    "follow_many-four.png",
    "nonlinear-coin_slide.png",
    "nonlinear-mouse_run.png",
}
NAMES = {  # of the functions that draw, by script
    "chip_figures": ["1.1", "1.2"],
    "trajectory_figures": ["2.1", "2.2", "2.3", "2.4", "2.5"],
    "fusion_figures": ["2.9", "2.11", "2.12", "2.14", "2.15", "2.16"],
    "fusion_diagrams": ["2.6", "2.7", "2.8", "2.10", "2.13"],
    "keypoint_figures": ["3.1", "3.2", "3.3", "3.4", "3.5"],
    "orientation_diagrams": ["3.6", "3.7", "3.10", "3.11"],
}


def text_of(drawing: Path) -> str:
    """The labels of a drawing: Matplotlib leaves each as a comment beside its paths."""
    found = re.findall(r"<!-- (.*?) -->", drawing.read_text(encoding="utf-8"), re.DOTALL)
    return "\n".join(found)


def test_only_pictures_are_made_of_pixels() -> None:
    assert {name for name in FIGURES if name.endswith(".png")} == PICTURES
    assert all(name.endswith((".svg", ".png")) for name in FIGURES)


def test_every_figure_is_shown_and_every_figure_that_is_shown_exists() -> None:
    shown = set(re.findall(r"\(figures/([^)]+)\)", PAGES))
    assert shown <= {*FIGURES}
    assert {name for name in FIGURES if not name.startswith("debugger-")} <= shown


def test_every_figure_of_the_thesis_is_there() -> None:
    numbers = [f"1.{n}" for n in (1, 2)]
    numbers += [f"2.{n}" for n in range(1, 17)] + [f"3.{n}" for n in range(1, 18)]
    assert {f"figure-{number}" for number in numbers} == {
        name.rpartition(".")[0] for name in FIGURES if name.startswith("figure-")
    }


@pytest.mark.parametrize("name", [name for name in FIGURES if name.endswith(".svg")])
def test_a_drawing_is_small_and_has_no_date(name: str) -> None:
    data = (FOLDER / name).read_bytes()
    assert b"<svg " in data
    assert data.rstrip().endswith(b"</svg>")
    assert len(data) < 300_000
    assert b"<dc:date>" not in data
    assert b"matplotlib.org" not in data


@pytest.mark.long
@pytest.mark.parametrize("name", ["2.13", "3.7"])
def test_a_drawing_is_the_same_each_time(name: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    script = next(script for script, names in NAMES.items() if name in names)
    from examples.drawing import save

    module = import_module(f"examples.{script}")
    key = f"figure-{name}"
    for folder in ("a", "b"):
        save({key: module.DRAWN[key]}, tmp_path / folder)
    drawings = [(tmp_path / folder / f"{key}.svg").read_bytes() for folder in ("a", "b")]
    assert drawings[0] == drawings[1]


@pytest.mark.parametrize("script", NAMES)
def test_scripts_draw_the_figures_that_are_theirs(script: str) -> None:
    pytest.importorskip("matplotlib")
    drawn = import_module(f"examples.{script}").DRAWN
    assert [f"figure-{name}" for name in NAMES[script]] == [n for n in drawn if "figure" in n]


def test_the_network_has_sides_as_inputs_and_a_position_as_output() -> None:
    labels = text_of(FOLDER / "figure-3.10.svg")
    assert all(f"{name} of the camera" in labels for name in "xyz")
    assert "side 3" in labels


def test_the_test_set_up_shows_what_the_thesis_names() -> None:
    labels = text_of(FOLDER / "figure-1.2.svg")
    assert all(part in labels for part in ("f/1.0", "USB 2.0", "tripod", "holster"))


def test_no_prediction_is_shown_below_the_ground() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib import pyplot as plt

    from examples.trajectory_figures import figure_2_2
    from npchip.host.vision.motion import MARGIN

    figure = figure_2_2()
    lines = [line for axes in figure.axes for line in axes.lines]
    predicted = [line for line in lines if line.get_label() == "predicted centre"]
    rows = np.concatenate([np.asarray(line.get_ydata(), float) for line in predicted])
    plt.close(figure)
    assert len(rows) > 20
    assert rows.max() <= 63 - MARGIN


@pytest.mark.parametrize("name", ["2.13", "2.14"])
def test_labels_lie_inside_their_figure_and_do_not_touch_each_other(name: str) -> None:
    pytest.importorskip("matplotlib")
    from matplotlib import pyplot as plt

    from examples.drawing import STYLE

    script = "fusion_diagrams" if name == "2.13" else "fusion_figures"
    with plt.rc_context(STYLE):
        figure = import_module(f"examples.{script}").DRAWN[f"figure-{name}"]()
        figure.draw_without_rendering()
        boxes = [
            text.get_window_extent()
            for axes in figure.axes
            for text in [*axes.texts, axes.title, axes._left_title]  # noqa: SLF001
            if text.get_text()
        ]
        area = figure.bbox
        plt.close(figure)
    assert len(boxes) >= 4
    for number, box in enumerate(boxes):
        assert area.x0 <= box.x0 < box.x1 <= area.x1
        assert area.y0 <= box.y0 < box.y1 <= area.y1
        assert not any(box.overlaps(other) for other in boxes[:number])
