"""Style and writing of all Matplotlib figures."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from matplotlib import rc_context, rcdefaults, rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from npchip.base.files import write_bytes

STYLE: Final[Any] = {"font.family": "sans-serif", "font.size": 10.0}
INK, FAINT = "#333333", "#DDDDDD"


def write(
    make: Callable[[], Figure], path: Path, *, style: Any = STYLE, dpi: int = 150, **metadata: Any
) -> None:
    """Draw a figure and write it; equal figures give equal files.

    Args:
        make: function that draws the figure.
        path: a file name that ends in ``.png`` or ``.svg``.
        style: settings of Matplotlib.
        dpi: pixels of an inch.
        metadata: entries of a PNG; None omits an entry.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    form = path.suffix.lower().lstrip(".")
    buffer = io.BytesIO()
    with rc_context():
        rcdefaults()  # a user's own settings may need what is not installed
        rcParams.update({"svg.hashsalt": "npchip"} | style)
        about = {"Date": None, "Creator": None} if form == "svg" else metadata or None
        make().savefig(buffer, format=form, dpi=dpi, metadata=about)
    write_bytes(path, buffer.getvalue())


def bars(axes: Axes, labels: Sequence[str], ends: Sequence[float], room: float, title: str) -> None:
    """Lay out horizontal bars of cycles, the first one on top.

    Args:
        axes: the axes with the bars.
        labels: labels of the bars.
        ends: cycles at which the bars end.
        room: width of the axis, relative to the longest bar.
        title: title above the bars.
    """
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlim(0, room * max(ends, default=0) or 1)
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.grid(axis="x", color=FAINT, zorder=0)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.set_title(title, loc="left", fontsize=10, color=INK)


def beside(axes: Axes, place: int, end: float, text: str, **style: Any) -> None:
    """Write a text to the right of a bar."""
    axes.annotate(
        text,
        (end, place),
        xytext=(5, 0),
        textcoords="offset points",
        va="center",
        color=INK,
        **style,
    )
