"""Write docs/orientation.md: every figure in it comes from a run.

    python -m examples.orientation_page [FOLDER]       (needs the extra `orient`)

FOLDER keeps what ``npchip orient table --json`` says of each data set, since that takes half a
minute each; what is there is not measured again. Set OPENBLAS_NUM_THREADS=1, as the command does.
The figures of docs/figures are drawn by
``npchip orient plot -o docs/figures --seed 1`` and ``python -m examples.orientation_diagrams``.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from examples.measure import ROOT, table
from examples.orientation_files import ARRAYS, SEED, padded
from npchip import Chip, assemble, load_machine
from npchip.host.vision.orientation import dataset, eightbit, experiment, models
from npchip.host.vision.orientation.corners import corner_pixels
from npchip.host.vision.orientation.network import split
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import CAMERAS, random_positions, spherical, yaw_and_pitch

PAGE = ROOT / "docs" / "orientation.md"
TEMPLATE = Path(__file__).with_name("orientation_page.md")
FILES = ROOT / "examples" / "orientation"
SETS: dict[str, tuple[dataset.Source, str, int, int]] = {
    "rendered-100x100": ("rendered", "100x100", 5, 4),
    "rounded-100x100": ("rounded", "100x100", 3, 3),
    "exact-100x100": ("exact", "100x100", 3, 3),
    "rendered-64x80": ("rendered", "64x80", 3, 3),
}
"""The source of vertices, the frame, and the numbers of trainings and of sets of poses."""

Document = dict[str, Any]


def measured(folder: Path) -> dict[str, list[Document]]:
    """Measure each data set for the table, on several sets of poses."""
    found: dict[str, list[Document]] = {name: [] for name in SETS}
    for name, (source, size, seeds, sets) in SETS.items():
        for seed in range(1, sets + 1):
            file = folder / f"{name}-{seed}.json"
            if not file.exists():
                settings = dataset.Settings(seed=seed, source=source, camera=CAMERAS[size])
                table = experiment.measure(dataset.make(settings), seeds)
                file.write_text(json.dumps(table.document()))
            found[name].append(json.loads(file.read_text()))
    return found


def merged(documents: list[Document]) -> Document:
    """Join measurements on several sets of poses: medians, and the totals of all trainings."""
    lines = []
    for same in zip(*(document["rows"] for document in documents), strict=True):
        totals = [total for row in same for total in row["totals_mm"]]
        lines.append(
            same[0]
            | {
                "rms_mm": np.median([row["rms_mm"] for row in same], axis=0).tolist(),
                "total_mm": float(np.median(totals)),
                "totals_mm": totals,
            }
        )
    return documents[0] | {"rows": lines}


def compared(documents: list[Document], name: str) -> list[float]:
    """Total error of a row over that of the hybrid model, for each set of poses."""
    known = map(rows, documents)
    return [each[name]["total_mm"] / each["hybrid"]["total_mm"] for each in known]


def _percent(ratios: list[float], digits: int = 0) -> str:
    ends = (f"{100 * (end(ratios) - 1):+.{digits}f}" for end in (min, max))
    return " to ".join(ends).replace("-", "–") + " %"


def rows(document: Document) -> dict[str, Document]:
    """Rows by name and angles, such as ``hybrid 1°/1°``; without errors by name alone."""
    return {_name(row): row for row in document["rows"]}


def _name(row: Document) -> str:
    angles = row["angle_errors_deg"]
    if angles and any(angles):
        return f"{row['name']} {angles[0]:g}°/{angles[1]:g}°"
    return str(row["name"])


def _three(values: list[float] | None, digits: int = 0) -> str:
    return " / ".join(f"{value:.{digits}f}" for value in values) if values else "–"


def whole_table(document: Document) -> str:
    """Table 3.1 and what is better."""
    lines = []
    for row in document["rows"]:
        angles = row["angle_errors_deg"]
        if angles and any(angles):
            continue
        low, high = min(row["totals_mm"]), max(row["totals_mm"])
        counts = [row[key] for key in ("inputs", "multiplications", "constants")]
        lines.append(
            [
                row["name"],
                "–" if angles is None else "known",
                _three(row["thesis_rms_mm"], 1),
                _three(row["rms_mm"], 1),
                f"{row['total_mm']:.0f}",
                f"{low:.0f}–{high:.0f}",
                *(str(count or "–") for count in counts),
            ]
        )
    head = ["RMS, mm: x / y / z", "angles", "thesis", "measured", "total", "range"]
    return table([*head, "inputs", "mul, div", "constants"], lines, 5)


def errors_table(document: Document) -> str:
    """Totals with errors of compass and pitch."""
    known = rows(document)
    names = [name for name in known if f"{name} 1°/1°" in known]
    angles = ["", *(f" {a:g}°/{b:g}°" for a, b in experiment.ANGLE_ERRORS)]
    lines = [[name, *(f"{known[name + a]['total_mm']:.0f}" for a in angles)] for name in names]
    return table(["total, mm", "exact", *(a.strip() for a in angles[1:])], lines, 4)


def sources_table(documents: dict[str, Document]) -> str:
    """The thesis's models with vertices of different quality, and on the smaller frame."""
    names = (
        *("side lengths", "vertices", "hybrid", "hybrid, 10 neurons", "hybrid, 8 bits"),
        *("side ratios, 6 neurons", "least squares"),
    )
    sets = ("exact-100x100", "rounded-100x100", "rendered-100x100", "rendered-64x80")
    lines = [
        [name, *(_three(rows(documents[each])[name]["rms_mm"]) for each in sets)] for name in names
    ]
    titles = ("exact", "rounded to pixels", "rendered", "rendered, 64 × 80")
    return table(["RMS, mm: x / y / z", *titles], lines)


def chip_table() -> str:
    """Words, cycles and errors of asm/orientation.s on the test set; it must be exact."""
    lines = []
    for size, (camera, array) in ARRAYS.items():
        data = dataset.make(dataset.Settings(camera=camera))
        parts = split(len(data), SEED)
        positions = random_positions(4_000, 1, camera)[parts.test]
        frames = padded(render(positions, camera), array)
        network = eightbit.load(FILES / f"chip-{size}.json")
        points = [corner_pixels(frame) for frame in frames]
        sides = eightbit.half_pixel_sides(np.array(points))
        cells = []
        for timing in ("default", "conservative"):
            machine = replace(load_machine(timing), np_rows=array[0], np_cols=array[1])
            program = assemble(ROOT / "asm" / "orientation.s", machine)
            chip = Chip(program, machine)
            chip.load_memory(eightbit.ADDRESS, network.planes(*array))
            result = chip.run(frames)
            sent = np.asarray(result.outputs["distance"])
            assert np.array_equal(sent, network.millimetres(sides)), "not exact"
            cycles = result.frame_cycles
            cells += [f"{cycles.mean():,.0f}", f"{cycles.max():,}"]
        radial = spherical(positions)[:, 0]
        error = float(np.sqrt(np.mean((sent - radial) ** 2)))
        float_network = models.train_model("hybrid", data, parts, seed=SEED)
        found = float_network(data.vertices[parts.test], yaw_and_pitch(positions)) - positions
        in_floats = float(np.sqrt((found**2).sum(axis=1).mean()))
        name = f"{size.replace('x', ' × ')}, {array[0]} × {array[1]} NPs"
        lines.append([name, f"{len(program.words)}", *cells, f"{error:.1f}", f"{in_floats:.1f}"])
    head = ["frame", "words", "cycles, mean", "worst", "conservative, mean", "worst"]
    return table([*head, "RMS, mm", "in floats"], lines, 7)


def document(folder: Path) -> str:
    """Return the text of docs/orientation.md."""
    every = measured(folder)
    documents = {name: merged(found) for name, found in every.items()}
    main, each = documents["rendered-100x100"], every["rendered-100x100"]
    known = rows(main)
    eight, small = (
        compared(each, name) for name in ("hybrid, 8 bits", "hybrid, 8 bits, 10 neurons")
    )
    lengths = [rows(document)["side lengths"]["total_mm"] for document in each]
    text = TEMPLATE.read_text(encoding="utf-8")
    for mark, value in {
        "table": whole_table(main),
        "errors": errors_table(main),
        "sources": sources_table(documents),
        "chip": chip_table(),
        "hybrid": f"{known['hybrid']['total_mm']:.0f}",
        "sets": str(len(each)),
        "others": str(SETS["exact-100x100"][3]),
        "lengths": f"{min(lengths):.0f}–{max(lengths):.0f}",
        "least": f"{known['least squares']['total_mm']:.0f}",
        "ten": _percent(compared(each, "hybrid, 10 neurons")),
        "ratios": _percent(compared(each, "side ratios, 6 neurons")),
        "eight": f"{min(eight):.2f}–{max(eight):.2f}",
        "small": f"{min(small):.2f}–{max(small):.2f}",
        "sine": _percent(compared(each, "hybrid, Bhaskara's sine"), 1),
    }.items():
        assert f"@{mark}@" in text
        text = text.replace(f"@{mark}@", value)
    return text


def main() -> None:
    """Write the page."""
    with TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1] if len(sys.argv) > 1 else temporary)
        PAGE.write_text(document(folder), encoding="utf-8")


if __name__ == "__main__":
    main()
