"""Table 2.1 of the thesis beside measured values, as a table, Markdown or JSON."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from npchip.base.json import one_line
from npchip.host.vision.fusion.experiment import SET, Row, Setting
from npchip.host.vision.fusion.rigfile import rig_as_data

SCHEMA: Final = 1
NONE: Final = "–"
LEGEND: Final = (
    "RMS distance to the truth. 5–95 %: of sets of {sets} paths (Q{bits}, else float).\n"
    "×/÷/<: multiplications, divisions, comparisons, counted. table: entries.\n"
)


def rows(setting: Setting, measured: Sequence[Row]) -> list[list[str]]:
    """Return the cells of the table of one setting, heads first.

    Args:
        setting: cameras and word lengths.
        measured: its rows; without values of the thesis its column is omitted.
    """
    q = f"Q{setting.form.fraction_bits}"
    heads = ["metres", "thesis ×/÷", q, "5–95 %", "float", "×/÷/<", "table"]
    cells = [heads, *(_cells(row) for row in measured)]
    if any(row.thesis for row in measured):
        return cells
    return [[line[0], *line[2:]] for line in cells]


def _cells(row: Row) -> list[str]:
    cost = row.operations
    kinds = ("multiplications", "divisions", "comparisons")
    return [
        row.title,
        f"{metres(row.thesis[2])} {row.thesis[0]}/{row.thesis[1]}" if row.thesis else NONE,
        metres(row.fixed),
        f"{metres(row.low)}–{metres(row.high)}",
        metres(row.real),
        "/".join(str(cost[kind]) for kind in kinds) if cost else NONE,
        str(row.entries),
    ]


def metres(value: float | None) -> str:
    """Return a distance with four decimals, as the thesis prints it."""
    return NONE if value is None else f"{value:.4f}".removeprefix("0")


def legend(setting: Setting, measured: Sequence[Row]) -> str:
    """Return an explanation of the columns, with the algorithms that marked positions invalid."""
    text = LEGEND.format(sets=SET, bits=setting.form.fraction_bits)
    for row in measured:
        if row.marked:
            text += (
                f"{row.title}: {100 * row.marked:.2f} % of the positions are marked as invalid.\n"
            )
    return text


def headline(setting: Setting, paths: int, seed: int) -> str:
    """Return the line above the table of a setting."""
    one = setting.rig.camera1
    apart = abs(one.position[0] - setting.rig.camera2.position[0])
    return (
        f"{setting.title}: {one.rows} x {one.cols} pixels, ratio {one.ratio:g}, cells of"
        f" {setting.rig.cell}, {apart:g} m; {paths:,} paths, seed {seed}"
    )


def text(
    results: Mapping[str, tuple[Setting, Sequence[Row]]],
    paths: int,
    seed: int,
    layout: Callable[[list[list[str]]], str],
) -> str:
    """Return the tables of all settings, each with its headline and legend."""
    return "\n".join(
        f"{headline(setting, paths, seed)}\n{layout(rows(setting, measured))}"
        f"{legend(setting, measured)}"
        for setting, measured in results.values()
    )


def markdown(setting: Setting, measured: Sequence[Row]) -> str:
    """Return the table of one setting as Markdown."""
    heads, *cells = rows(setting, measured)
    lines = [heads, ["---"] * len(heads), *cells]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def to_text(results: Mapping[str, tuple[Setting, Sequence[Row]]], paths: int, seed: int) -> str:
    """Return results as JSON, schema 1 of ``docs/fusion.md``, with a line for each row."""
    settings = []
    for name, (setting, measured) in results.items():
        lines = ",\n   ".join(one_line(_row(row)) for row in measured)
        head = one_line({"name": name, "title": setting.title, **_setting(setting)})[1:-1]
        settings.append(f'{{{head},\n  "rows": [\n   {lines}\n  ]}}')
    whole = ",\n  ".join(settings)
    return (
        f'{{\n "schema": {SCHEMA},\n "paths": {paths},\n "seed": {seed},\n'
        f' "settings": [\n  {whole}\n ]\n}}\n'
    )


def _setting(setting: Setting) -> dict[str, Any]:
    form = setting.form
    return {
        "fitted": setting.thesis,
        "rig": rig_as_data(setting.rig),
        "fraction_bits": form.fraction_bits,
        "word_bits": form.word_bits,
        "product_bits": form.product_bits,
    }


def _row(row: Row) -> dict[str, Any]:
    thesis = row.thesis and dict(
        zip(("multiplications", "divisions", "rms"), row.thesis, strict=True)
    )
    needed = row.bits and dict(zip(("word", "product"), row.bits, strict=True))
    return {
        "algorithm": row.name,
        "title": row.title,
        "thesis": thesis,
        "rms": row.best,
        "rms_float": row.real,
        "rms_fixed": row.fixed,
        "low": row.low,
        "high": row.high,
        "operations": row.operations,
        "table_entries": row.entries,
        "bits": needed,
        "marked": row.marked,
    }
