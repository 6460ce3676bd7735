"""Writing of the figures of docs/: as SVG, the same on every day."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import matplotlib as mpl

from examples.target import asked
from npchip.report.figure import write

mpl.use("Agg")

from matplotlib import pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from matplotlib.figure import Figure

FIGURES: Final = Path(__file__).parents[1] / "docs" / "figures"
GREEN, RED, BLUE, INK, FAINT = "#1a9850", "#e0301e", "#2166ac", "#222222", "#999999"
STYLE: Final[Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.edgecolor": FAINT,
    "text.color": INK,
}


def save(figures: Mapping[str, Callable[[], Figure]], folder: Path = FIGURES, **style: Any) -> None:
    """Draw figures into `folder`, as NAME.svg by their names, in a style that differs as said."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in figures.items():
        write(draw, folder / f"{name}.svg", style=STYLE | style)
        plt.close("all")


def save_as_asked(figures: Mapping[str, Callable[[], Figure]], **style: Any) -> None:
    """Draw figures into the folder that the command line names, else into docs/figures."""
    save(figures, asked(FIGURES), **style)
