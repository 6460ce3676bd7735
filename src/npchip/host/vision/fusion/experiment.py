"""Table 2.1 of the thesis: random straight paths, seen by two cameras, located by every algorithm.

The thesis states neither the positions of its cameras nor the motion of its object. Cameras and
paths here were *fitted* to its table (decision; ``docs/fusion.md``): equal figures show that the
equations and the setting are plausible, not that it is the thesis's setting.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from npchip.base.errors import InputError
from npchip.host.vision.fusion.arithmetic import CHIP, Q12, QFormat
from npchip.host.vision.fusion.beyond import fit_path
from npchip.host.vision.fusion.camera import Camera, Floats, Rig
from npchip.host.vision.fusion.crossing import Status, crossing
from npchip.host.vision.fusion.locate import Positions, locate, needed_bits
from npchip.host.vision.fusion.registry import ALGORITHMS, count

SAMPLES: Final = 20
SET: Final = 100
"""Number of paths in a set; the spread of the errors is that of sets."""

MARGIN: Final = 1 / 40
"""Distance of the ends of a path from the border, as a part of the frame's width."""

MOST_PATHS: Final = 20_000
"""Most paths of an experiment: a minute and 300 MB."""


@dataclass(frozen=True, kw_only=True)
class Setting:
    """Cameras and word lengths of an experiment.

    Attributes:
        title: title in tables.
        rig: the cameras.
        form: word lengths.
        thesis: whether the setting was fitted to the thesis's table.
    """

    title: str
    rig: Rig
    form: QFormat
    thesis: bool = False


def _rig(size: tuple[int, int], ratio: float, distance: float, cell: int) -> Rig:
    rows, cols = size
    return Rig(
        camera1=Camera(position=(distance, 0, 0), looks="+y", ratio=ratio, rows=rows, cols=cols),
        camera2=Camera(position=(0, distance, 0), looks="+x", ratio=ratio, rows=rows, cols=cols),
        cell=cell,
    )


SETTINGS: Final[Mapping[str, Setting]] = {
    "thesis": Setting(
        title="fitted to the thesis",
        rig=_rig((160, 160), 128, 4.0, 16),
        form=Q12,
        thesis=True,
    ),
    "chip": Setting(
        title="the chip's own size",
        rig=_rig((64, 80), 64, 2.3, 8),
        form=replace(CHIP, product_bits=28),  # the similarity triangle does not fit three bytes
    ),
}


def straight_paths(rig: Rig, paths: int, rng: np.random.Generator) -> Floats:
    """Draw straight paths in the common view of both cameras.

    The pixel of camera 1 and the column of camera 2 at each end are uniform over the frames,
    `MARGIN` inside their borders, provided that camera 2 sees the end. The common view is convex,
    so both cameras see the whole path.

    Args:
        rig: the cameras.
        paths: number of paths.
        rng: source of the random numbers.

    Returns:
        float64, shape (paths, `SAMPLES`, 3), metres; samples are at equal distances.

    Raises:
        InputError: NP510, the cameras see (almost) nothing in common.
    """
    one, two = rig.camera1, rig.camera2
    found: list[Floats] = []
    tries = missing = 2 * paths
    for _ in range(1000):
        h1 = rng.uniform(-1, 1, tries) * (one.cols / 2 - MARGIN * one.cols)
        h2 = rng.uniform(-1, 1, tries) * (two.cols / 2 - MARGIN * two.cols)
        v1 = rng.uniform(-1, 1, tries) * (one.rows / 2 - MARGIN * one.cols)
        meet = crossing(rig, h1, h2)
        z = one.position[2] + (meet.y - one.position[1]) * v1 / one.ratio
        ends = np.stack([meet.x, meet.y, z], -1)[meet.status == Status.OK]
        _, v2 = two.offsets(two.project(ends)[0])
        found.append(ends[np.abs(v2) <= two.rows / 2 - MARGIN * two.cols])
        missing -= len(found[-1])
        if missing <= 0:
            break
    else:
        raise InputError(
            "NP510",
            "the two cameras see nothing in common",
            hint="turn or move them so that their views overlap",
        )
    ends = np.concatenate(found)[: 2 * paths].reshape(paths, 2, 1, 3)
    along = np.linspace(0, 1, SAMPLES)[:, None]
    return np.asarray(ends[:, 0] * (1 - along) + ends[:, 1] * along)


def rms(points: Floats, truth: Floats) -> float:
    """Return the RMS distance of points, shape (..., 3), that are not NaN; NaN without any."""
    squares = np.square(points - truth).sum(axis=-1)
    squares = squares[~np.isnan(squares)]
    return float(np.sqrt(squares.mean())) if squares.size else np.nan


@dataclass(frozen=True)
class Row:
    """Figures of one algorithm in one setting.

    Attributes:
        name: a key of `ALGORITHMS`, or ``"line"``.
        title: title in tables.
        real: RMS in metres, in floating point.
        low, high: 5 and 95 % quantile of sets of 100 paths, in Q format if possible.
        marked: part of the positions that are not valid.
        thesis: multiplications, divisions and RMS in metres of the thesis, or None.
        fixed: RMS in metres, in Q format; None if it computes in floating point only.
        operations: operations of one position, as `count` returns them.
        entries: numbers in its tables.
        bits: longest word and product in Q format, over all pixels; None without Q format.
    """

    name: str
    title: str
    real: float
    low: float
    high: float
    marked: float
    thesis: tuple[int, int, float] | None = None
    fixed: float | None = None
    operations: Mapping[str, int] | None = None
    entries: int = 0
    bits: tuple[int, int] | None = None

    @property
    def best(self) -> float:
        """RMS in metres to compare with the thesis: in Q format if possible."""
        return self.real if self.fixed is None else self.fixed


@dataclass(frozen=True, eq=False)
class Experiment:
    """Paths and their pixels in two cameras.

    Attributes:
        setting: cameras and word lengths.
        truth: float64, shape (paths, 20, 3), metres.
        seen1, seen2: float64, shape (paths, 20, 2): whole (row, column).
    """

    setting: Setting
    truth: Floats
    seen1: Floats
    seen2: Floats

    @classmethod
    def draw(cls, setting: Setting, paths: int, seed: int) -> Experiment:
        """Draw random paths.

        Raises:
            InputError: NP511, fewer than 1 or more than 20,000 paths.
        """
        if not 1 <= paths <= MOST_PATHS:
            raise InputError("NP511", f"paths: expected 1 to {MOST_PATHS}, found {paths}")
        truth = straight_paths(setting.rig, paths, np.random.default_rng(seed))
        rig = setting.rig
        return cls(setting, truth, rig.camera1.observe(truth), rig.camera2.observe(truth))

    def locate(self, name: str, form: QFormat | None = None) -> Positions:
        """Locate all samples by an algorithm."""
        return locate(self.setting.rig, self.seen1, self.seen2, name, form)

    def row(self, name: str) -> Row:
        """Measure an algorithm of `ALGORITHMS`."""
        algorithm, rig = ALGORITHMS[name], self.setting.rig
        real = self.locate(name)
        found = self.locate(name, self.setting.form) if algorithm.integers else real
        n1, n2, m = rig.cells
        low, high = self._spread(found.points)
        return Row(
            name=name,
            title=algorithm.title,
            thesis=algorithm.thesis if self.setting.thesis else None,
            real=rms(real.points, self.truth),
            fixed=rms(found.points, self.truth) if algorithm.integers else None,
            low=low,
            high=high,
            operations=count(name, rig),
            entries=sum(n1 * n2 * (m if axis == "z" else 1) for axis in algorithm.table),
            bits=needed_bits(rig, name) if algorithm.integers else None,
            marked=float(1 - found.valid.mean()),
        )

    def line(self) -> Row:
        """Measure a straight line through each path's positions by reprojection."""
        found = self.locate("reprojection")
        points = fit_path(found.points, found.valid).at(np.arange(self.truth.shape[1]))
        return Row(
            "line",
            f"line, {self.truth.shape[1]} points",
            rms(points, self.truth),
            *self._spread(points),
            float(1 - found.valid.mean()),
        )

    def _spread(self, points: Floats) -> tuple[float, float]:
        whole = max(1, len(points) // SET)
        halves = (np.array_split(values, whole) for values in (points, self.truth))
        low, high = np.nanquantile([rms(*pair) for pair in zip(*halves, strict=True)], [0.05, 0.95])
        return float(low), float(high)


def table(
    setting: Setting,
    paths: int = 1000,
    seed: int = 1,
    *,
    on_row: Callable[[Row], None] | None = None,
) -> Sequence[Row]:
    """Measure all algorithms: those of the thesis first, in the order of table 2.1.

    Args:
        setting: cameras and word lengths, such as those of `SETTINGS`.
        paths: number of random paths of 20 positions.
        seed: seed of the random numbers.
        on_row: called with every row when it is done.

    Raises:
        InputError: NP510, NP511.
    """
    experiment = Experiment.draw(setting, paths, seed)
    rows = []
    for name in (*ALGORITHMS, "line"):
        rows.append(experiment.line() if name == "line" else experiment.row(name))
        if on_row:
            on_row(rows[-1])
    return rows
