"""Figures 1.1 and 1.2 of the thesis: what the chip is made of, and how it was tried out.

    python -m examples.chip_figures [FOLDER]       (needs the extra `plot`)

1.2 is a photograph in the thesis; here it is drawn from its caption. In 1.1 the blocks and arrows
are the thesis's: data between adjacent NPs, instructions from the program ROM by way of the global
control unit (GCU), conversion signals from the ADC state machine, results over the column bus. Grey
labels say what this project has decided or emulates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.patches import Ellipse, FancyBboxPatch, Polygon, Rectangle

from examples.drawing import save_as_asked
from npchip import load_machine

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, FAINT, DECISION = "#222222", "#b8b8b8", "#777777"
NP, PIXELS = "#dceaf7", "#f7f7f7"
DATA, PROGRAM, ANALOG = "#2166ac", "#1a9850", "#e08214"


def figure_1_1() -> Figure:
    """Draw the chip on the left, one NP on the right."""
    figure, axes = plt.subplots(figsize=(10.5, 5.7), layout="constrained")
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
    return figure


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


def figure_1_2() -> Figure:
    """Draw the camera on its tripod, what it looks at, and where its results go."""
    figure, axes = plt.subplots(figsize=(9.6, 4.3), layout="constrained")
    axes.set(xlim=(0, 19.2), ylim=(-0.6, 8.7), aspect="equal")
    axes.axis("off")
    axes.plot([0.6, 18.6], [0, 0], color=FAINT, lw=1)

    lens, far = (7.6, 5.6), 2.2  # the pinhole, and the distance of the object's plane
    axes.add_patch(Polygon([lens, (far, 7.3), (far, 3.9)], fc="#f3f7fb", ec="none"))
    for end in (7.3, 3.9):
        axes.plot([lens[0], far], [lens[1], end], color=DATA, lw=0.8)
    axes.plot([far, lens[0]], [lens[1]] * 2, "--", color=DATA, lw=0.7)
    axes.add_patch(Ellipse((far, 6.0), 0.9, 0.9, fc="#f7d9d5", ec="#c0392b", lw=1))
    arrow(axes, (far, 5.45), (far, 4.3), "#c0392b", "-|>", 10)
    axes.text(far, 3.3, "an object moves", ha="center", color=INK)

    axes.add_patch(Rectangle((8.5, 4.75), 2.4, 1.7, fc="#dddddd", ec=INK, lw=1))  # the holster
    axes.add_patch(Rectangle((8.75, 4.95), 0.22, 1.3, fc=NP, ec=DATA, lw=1))
    axes.add_patch(Rectangle((8.97, 4.85), 0.14, 1.5, fc=PROGRAM, ec="none"))
    axes.add_patch(Rectangle((7.75, 5.1), 0.75, 1.0, fc="#555555", ec=INK, lw=1))
    axes.add_patch(Ellipse((7.75, 5.6), 0.34, 1.15, fc="#cfe3f5", ec=INK, lw=1))
    labels = (
        ("lens, f/1.0", (7.75, 6.2), (7.0, 7.45)),
        ("vision chip, 64 x 80 pixels", (8.86, 6.2), (9.6, 7.45)),
        ("3D-printed holster", (10.7, 6.4), (12.6, 6.75)),
    )
    for text, at, place in labels:
        axes.plot([at[0], place[0]], [at[1], place[1] - 0.15], color=FAINT, lw=0.8)
        axes.text(*place, text, ha="center", va="bottom")

    axes.add_patch(Rectangle((9.35, 4.1), 0.7, 0.65, fc="#555555", ec=INK, lw=1))
    for foot in (7.7, 9.7, 11.7):
        axes.plot([9.7, foot], [4.1, 0], color=INK, lw=3, solid_capstyle="round")
    axes.plot([8.7, 10.7], [2.05, 2.05], color=INK, lw=1)
    axes.text(12.0, 0.3, "tripod")

    turn = np.linspace(0, 1, 60)  # the cable hangs
    axes.plot(10.9 + 3.3 * turn, 5.4 - 2.2 * turn - 2.4 * turn * (1 - turn), color=ANALOG, lw=1.8)
    axes.text(12.95, 4.15, "USB 2.0", color=ANALOG)
    box(axes, (14.2, 2.2), (4.2, 2.4), "white")
    axes.add_patch(Rectangle((14.4, 2.4), 3.8, 2.0, fc=PIXELS, ec=FAINT, lw=0.8))
    axes.add_patch(
        Polygon([(13.9, 1.75), (18.7, 1.75), (18.4, 2.2), (14.2, 2.2)], fc="#dddddd", ec=INK)
    )
    axes.plot([13.4, 19.0], [1.7, 1.7], color=INK, lw=2)
    for foot in (14.0, 18.4):
        axes.plot([foot] * 2, [0, 1.7], color=INK, lw=2)
    axes.text(16.3, 3.4, "computer:\nprograms out, results in", ha="center", va="center")
    for text, place in (
        ("--frames CLIP", (far, 2.75)),
        ("emulated by npchip", (9.6, 8.45)),
        ("table, JSON, pictures", (16.3, 5.0)),
    ):
        axes.text(*place, text, color=DECISION, size=8, ha="center", va="top")
    return figure


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


DRAWN = {"figure-1.1": figure_1_1, "figure-1.2": figure_1_2}

if __name__ == "__main__":
    save_as_asked(DRAWN)
