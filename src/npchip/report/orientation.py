"""Table 3.1 and estimated positions as text."""

from __future__ import annotations

from collections.abc import Sequence

from npchip.host.vision.orientation.experiment import Row, Table
from npchip.host.vision.orientation.predict import Estimate

TABLE_HEAD = (
    *("", "angles", "thesis x", "y", "z", "x", "y", "z", "total", "spread"),
    *("inputs", "mul/div", "constants"),
)
ESTIMATE_HEAD = ("picture", "x", "y", "z", "radial", "polar", "azimuth")


def table_cells(table: Table) -> list[list[str]]:
    """Return the cells of table 3.1, heads first; errors are in mm."""
    return [list(TABLE_HEAD), *(_row(row) for row in table.rows)]


def _row(row: Row) -> list[str]:
    angles = "-"
    if row.angle_errors is not None:
        compass, pitch = row.angle_errors
        angles = f"{compass:g}°/{pitch:g}°" if compass or pitch else "exact"
    thesis = [f"{value:.1f}" for value in row.thesis] if row.thesis else ["-"] * 3
    measured = [f"{value:.1f}" for value in row.median]
    low, high = row.totals.min(), row.totals.max()
    cost = row.operations
    counts = [cost.inputs, cost.multiplications, cost.constants]
    return [
        row.name,
        angles,
        *thesis,
        *measured,
        f"{row.total:.1f}",
        f"{low:.0f}-{high:.0f}",
        *(str(count) if cost.inputs else "-" for count in counts),
    ]


def table_foot(table: Table) -> list[str]:
    """Return lines that explain the data and the columns of table 3.1."""
    data = table.data
    return [
        (
            f"RMS errors in mm, median of {table.seeds} seeds, each tested on"
            f" {data['poses'] - round(0.85 * data['poses'])} of {data['poses']} poses"
            f" (seed {data['seed']}); vertices {data['vertices']}, {data['rows']} x {data['cols']}"
            f" pixels, F {data['focal']:g}."
        ),
        "total: root of the sum of the squares; spread: its range over the seeds.",
        (
            "angles: standard deviation of compass/pitch. The setting is fitted to the thesis's"
            " table: agreement shows plausibility."
        ),
    ]


def estimate_cells(estimates: Sequence[Estimate]) -> list[list[str]]:
    """Return cells, heads first: positions in mm and angles in degrees, or the error's code."""
    lines = [list(ESTIMATE_HEAD)]
    for item in estimates:
        if item.position is None:
            code = item.error.code if item.error else "-"
            lines.append([item.name, code, *["-"] * 5])
            continue
        x, y, z = item.position
        radial, polar, azimuth = item.spherical
        lines.append(
            [
                item.name,
                *(f"{value:.0f}" for value in (x, y, z, radial)),
                f"{polar:.1f}",
                f"{azimuth:.1f}",
            ]
        )
    return lines
