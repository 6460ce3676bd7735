"""Figure 1.1 of the thesis: what the chip is made of, and what moves where.

    python examples/chip_figure.py [FOLDER]       (needs the extra `plot`)

The blocks and arrows are the thesis's: data between adjacent NPs, instructions from the program ROM
by way of the global control unit (GCU), conversion signals from the ADC state machine, results over
the column bus. Grey labels say what this project has decided about them.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl

from npchip import load_machine

mpl.use("Agg")

from matplotlib import pyplot as plt
from matplotlib.patches import FancyBboxPatch, Rectangle

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FIGURES = Path(__file__).parents[1] / "docs" / "figures"
INK, FAINT, DECISION = "#222222", "#b8b8b8", "#777777"
NP, PIXELS = "#dceaf7", "#f7f7f7"
DATA, PROGRAM, ANALOG = "#2166ac", "#1a9850", "#e08214"


def main(folder: Path = FIGURES) -> None:
    """Write the figure into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    style: Any = {"font.size": 9}
    with plt.rc_context(style):
        figure, axes = plt.subplots(figsize=(10.5, 5.7), layout="constrained")
        draw(axes)
        figure.savefig(folder / "figure-1.1.png", dpi=100, metadata={"Software": None})
        plt.close(figure)


def draw(axes: Axes) -> None:
    """Draw the chip on the left, one NP on the right."""
    machine = load_machine("default")
    rows, cols = machine.geometry
    axes.set(xlim=(-4.7, 19.6), ylim=(-3.3, 9.0))
    axes.set_aspect("equal")
    axes.axis("off")
    axes.add_patch(
        Rectangle((-4.5, -3.2), 15.3, 12.1, fill=False, ec=FAINT, ls=(0, (5, 3)), lw=1.2)
    )
    axes.text(10.6, 8.55, "chip boundary", color=DECISION, ha="right", va="center", size=8)

    for row in range(rows):
        for col in range(cols):
            box(axes, (col, row), (0.72, 0.72), NP)
            axes.text(col + 0.36, row + 0.36, "NP", ha="center", va="center", size=7)
            if col + 1 < cols:
                arrow(axes, (col + 0.74, row + 0.36), (col + 1, row + 0.36), DATA, "<->", 4)
            if row + 1 < rows:
                arrow(axes, (col + 0.36, row + 0.74), (col + 0.36, row + 1), DATA, "<->", 4)
    axes.text(cols / 2 - 0.14, rows + 0.15, f"{rows} x {cols} neighborhood processors", ha="center")

    box(axes, (-0.2, -1.35), (cols + 0.12, 0.7), "white")
    axes.text(cols / 2 - 0.14, -1.0, "column data bus", ha="center", va="center")
    for col in range(cols):
        arrow(axes, (col + 0.36, -0.03), (col + 0.36, -0.62), DATA, "-|>", 7)
    arrow(axes, (cols / 2, -1.38), (cols / 2, -2.6), DATA, "-|>", 10)
    axes.text(cols / 2 + 0.2, -2.3, "results: one row of NPs at a time", color=DECISION, size=8)

    blocks = (
        (5.7, f"program ROM\n{machine.rom_words} instructions", PROGRAM),
        (3.2, "global control\nunit (GCU)", PROGRAM),
        (0.7, "ADC state\nmachine", ANALOG),
    )
    for bottom, text, color in blocks:
        box(axes, (-4.2, bottom), (2.7, 1.5), "white", color)
        axes.text(-2.85, bottom + 0.75, text, ha="center", va="center", size=8.5)
    arrow(axes, (-2.4, 5.67), (-2.4, 4.73), PROGRAM, "-|>", 10)
    axes.text(-2.25, 5.2, "instruction", size=8, va="center", color=PROGRAM)
    arrow(axes, (-3.3, 4.73), (-3.3, 5.67), PROGRAM, "-|>", 10)
    axes.text(-3.42, 5.2, "address", size=8, va="center", ha="right", color=PROGRAM)
    arrow(axes, (-1.47, 4.3), (-0.1, 4.3), PROGRAM, "-|>", 10)
    axes.text(-0.8, 4.42, "program", size=8, ha="center", color=PROGRAM)
    arrow(axes, (-0.1, 3.6), (-1.47, 3.6), DECISION, "-|>", 10)
    axes.text(-0.8, 3.1, "global\nOR", size=8, ha="center", va="center", color=DECISION)
    arrow(axes, (-1.47, 1.45), (-0.1, 1.45), ANALOG, "-|>", 10)
    axes.text(-0.8, 1.57, "convert", size=8, ha="center", color=ANALOG)
    arrow(axes, (-2.85, 3.17), (-2.85, 2.23), ANALOG, "-|>", 10)

    one_np(axes, machine.memory_bytes)
    for corner in ((cols - 0.28, rows - 0.28), (cols - 0.28, rows - 1)):
        x, y = corner
        axes.plot([x, 12.1], [y, 7.9 if y > rows - 0.5 else 0.2], color=FAINT, lw=0.8)


def one_np(axes: Axes, memory: int) -> None:
    """An NP: its pixels with their ADCs, memory, registers and ALU."""
    left, bottom = 12.1, 0.2
    axes.add_patch(Rectangle((left, bottom), 7.2, 7.7, fc=NP, ec=INK, lw=1))
    axes.text(left + 3.6, 8.25, "one neighborhood processor", ha="center", va="center")
    size = 0.4
    for row in range(8):
        for col in range(8):
            place = (left + 0.4 + size * col, 4.2 + size * row)
            axes.add_patch(Rectangle(place, size, size, fc=PIXELS, ec=FAINT, lw=0.7))
    axes.text(left + 2.0, 3.75, "8 x 8 pixels with ADCs", ha="center", va="center", size=8)
    box(axes, (left + 4.5, 5.7), (2.4, 1.7), "white")
    axes.text(left + 5.7, 6.75, "memory", ha="center", va="center")
    axes.text(left + 5.7, 6.2, f"{memory} bytes", ha="center", va="center", color=DECISION, size=8)
    box(axes, (left + 4.5, 3.2), (2.4, 1.7), "white")
    axes.text(left + 5.7, 4.25, "registers", ha="center", va="center")
    axes.text(left + 5.7, 3.7, "16 bytes", ha="center", va="center", color=DECISION, size=8)
    box(axes, (left + 4.5, 0.7), (2.4, 1.7), "white")
    axes.text(left + 5.7, 1.75, "8-bit ALU", ha="center", va="center")
    axes.text(left + 5.7, 1.2, "+  –  AND  OR  shift", ha="center", va="center", size=6.5)
    box(axes, (left + 0.4, 0.7), (3.2, 1.7), "white")
    axes.text(left + 2.0, 1.75, "links to 4 neighbours", ha="center", va="center", size=8)
    axes.text(left + 2.0, 1.2, "activity, C, Z", ha="center", va="center", color=DECISION, size=8)
    arrow(axes, (left + 3.65, 6.5), (left + 4.45, 6.5), ANALOG, "-|>", 10)
    arrow(axes, (left + 5.7, 5.67), (left + 5.7, 4.95), DATA, "<|-|>", 9)
    arrow(axes, (left + 5.7, 3.17), (left + 5.7, 2.45), DATA, "<|-|>", 9)
    arrow(axes, (left + 4.45, 3.5), (left + 2.9, 2.45), DATA, "<|-|>", 9)


def box(
    axes: Axes, at: tuple[float, float], size: tuple[float, float], fill: str, edge: str = INK
) -> None:
    """Draw a block."""
    style = "round,pad=0,rounding_size=0.08"
    axes.add_patch(FancyBboxPatch(at, *size, boxstyle=style, fc=fill, ec=edge, lw=1))


def arrow(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    *looks: Any,
) -> None:
    """Draw an arrow; `looks` are its color, style and size."""
    color, style, size = looks
    axes.annotate(
        "",
        end,
        start,
        arrowprops={
            "arrowstyle": style,
            "color": color,
            "lw": 1.1,
            "mutation_scale": size,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
