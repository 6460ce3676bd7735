"""Write docs/orientation.md: every figure in it comes from a run.

    python -m examples.orientation_page [FILE]       (needs the extras `orient` and `sweep`)

Its tables are those of the sweep ``table-3.1.yaml``, which runs here and takes about three
minutes of one core's time. Set OPENBLAS_NUM_THREADS=1, as ``npchip orient`` does.
The figures of docs/figures are drawn by ``npchip orient plot -o docs/figures --seed 1``,
``python -m examples.orientation_diagrams`` and ``python -m examples.sweep_figures``.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from examples.measure import ROOT, spread, swept, table, write_page
from examples.orientation_files import ARRAYS, SEED, padded
from npchip import Chip, assemble, load_machine
from npchip.host.vision.orientation import dataset, eightbit, experiment, models
from npchip.host.vision.orientation.corners import corner_pixels
from npchip.host.vision.orientation.network import split
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import random_positions, spherical, yaw_and_pitch

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from numpy.typing import NDArray

PAGE = ROOT / "docs" / "orientation.md"
TEMPLATE = Path(__file__).with_name("orientation_page.md")
FILES = ROOT / "examples" / "orientation"
RENDERED, SMALL = "rendered 100x100", "rendered 64x80"
THREE = ["x", "y", "z"]


def swept_rows(estimator: str, pictures: str = RENDERED) -> pd.DataFrame:
    """Return the trainings of an estimator."""
    return swept("table-3.1", pictures=pictures, estimator=estimator)


def estimators() -> list[str]:
    """Return the rows of the table."""
    return list(dict.fromkeys(swept("table-3.1")["estimator"]))


def compared(name: str) -> NDArray[np.float64]:
    """Total error of a row over that of the hybrid model, for each training."""
    ours, hybrid = (swept_rows(each)["total"].to_numpy() for each in (name, "hybrid"))
    return np.asarray(ours / hybrid)


def percent(name: str, digits: int = 0) -> str:
    """Return how much worse a row is than the hybrid model: mean and deviation."""
    worse = 100 * (compared(name) - 1)
    text = f"{worse.mean():+.{digits}f} ± {worse.std(ddof=1):.{digits}f} %"
    return text.replace("-", "–")


def three(values: Sequence[float] | NDArray[np.float64] | None, digits: int = 0) -> str:
    """Return errors along x, y and z."""
    return "–" if values is None else " / ".join(f"{value:.{digits}f}" for value in values)


def whole_table() -> str:
    """Table 3.1 and what is better."""
    lines = []
    for name in estimators():
        found = swept_rows(name)
        counts = [found[key].iloc[0] for key in ("inputs", "multiplications", "constants")]
        lines.append(
            [
                name,
                "–" if found["total_1_1"].isna().all() else "known",
                three(experiment.THESIS_ROWS.get(name), 1),
                three(found[THREE].mean().to_numpy(), 1),
                spread(found["total"], 0),
                *(f"{count:.0f}" if count else "–" for count in counts),
            ]
        )
    head = ["RMS, mm: x / y / z", "angles", "thesis", "measured", "total"]
    return table([*head, "inputs", "mul, div", "constants"], lines, 4)


def errors_table() -> str:
    """Totals with errors of compass and pitch."""
    names = ("hybrid", "hybrid, 8 bits", "side ratios, 6 neurons", "least squares")
    columns = ["total", *("total_{:g}_{:g}".format(*each) for each in experiment.ANGLE_ERRORS)]
    lines = [[name, *(spread(swept_rows(name)[key], 0) for key in columns)] for name in names]
    angles = [f"{a:g}°/{b:g}°" for a, b in experiment.ANGLE_ERRORS]
    return table(["total, mm", "exact", *angles], lines, 4)


def sources_table() -> str:
    """The thesis's models with vertices of different quality, and on the smaller frame."""
    names = (
        *("side lengths", "vertices", "hybrid", "hybrid, 10 neurons", "hybrid, 8 bits"),
        *("side ratios, 6 neurons", "least squares"),
    )
    sets = ("exact 100x100", "rounded 100x100", RENDERED, SMALL)
    lines = [
        [name, *(three(swept_rows(name, each)[THREE].mean().to_numpy()) for each in sets)]
        for name in names
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


def document() -> str:
    """Return the text of docs/orientation.md."""
    text = TEMPLATE.read_text(encoding="utf-8")
    for mark, value in {
        "table": whole_table(),
        "errors": errors_table(),
        "sources": sources_table(),
        "chip": chip_table(),
        "hybrid": f"{swept_rows('hybrid')['total'].mean():.0f}",
        "sets": str(swept_rows("hybrid")["poses"].nunique()),
        "trainings": str(swept_rows("hybrid")["seed"].nunique()),
        "lengths": spread(swept_rows("side lengths")["total"], 0),
        "least": f"{swept_rows('least squares')['total'].mean():.0f}",
        "ten": percent("hybrid, 10 neurons"),
        "ratios": percent("side ratios, 6 neurons"),
        "eight": spread(compared("hybrid, 8 bits"), 2),
        "small": spread(compared("hybrid, 8 bits, 10 neurons"), 2),
        "sine": percent("hybrid, Bhaskara's sine", 1),
    }.items():
        assert f"@{mark}@" in text
        text = text.replace(f"@{mark}@", value)
    return text


if __name__ == "__main__":
    write_page("orientation.md", document)
