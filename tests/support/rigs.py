"""Rigs for tests: those of the examples, and random ones of any geometry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip.host.vision.fusion import Camera, Rig, load_rig

RIGS = Path(__file__).parents[2] / "examples" / "rigs"
THESIS, CHIPS = load_rig(RIGS / "thesis.yaml"), load_rig(RIGS / "chip.yaml")

SEEDS = st.integers(0, 2**32 - 1)
PLACES = st.tuples(*[st.integers(-80, 80).map(lambda n: n / 8) for _ in range(3)])


@st.composite
def rigs(draw: st.DrawFn, *, power: bool = False) -> Rig:
    """Two cameras anywhere, facing any way at right angles; wide angles make rays parallel."""
    cell = draw(st.sampled_from([4, 8]))
    ratios = st.sampled_from([8, 16, 32, 64]) if power else st.integers(6, 99).map(lambda n: n / 2)
    rows = cell * draw(st.integers(2, 8))
    first = Camera(
        position=draw(PLACES),
        looks=draw(st.sampled_from(["+y", "-y"])),
        ratio=draw(ratios),
        rows=rows,
        cols=cell * draw(st.integers(2, 10)),
    )
    second = Camera(
        position=draw(PLACES.filter(lambda place: place != first.position)),
        looks=draw(st.sampled_from(["+x", "-x"])),
        ratio=draw(ratios),
        rows=rows,
        cols=cell * draw(st.integers(2, 10)),
    )
    return Rig(camera1=first, camera2=second, cell=cell)


def all_pairs(rig: Rig, row: int | None = None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Every pair of columns in both cameras, in a row (the middle one) of each: (n, 2) twice."""
    cols = np.meshgrid(np.arange(rig.camera1.cols), np.arange(rig.camera2.cols), indexing="ij")
    return tuple(  # type: ignore[return-value]  # two in, two out
        np.stack([np.full(at.size, camera.rows // 2 if row is None else row), at.ravel()], -1) * 1.0
        for at, camera in zip(cols, (rig.camera1, rig.camera2), strict=True)
    )


def random_pixels(rig: Rig, seed: int, number: int) -> tuple[NDArray[np.float64], ...]:
    """Whole pixels anywhere in both frames: (number, 2) twice."""
    rng = np.random.default_rng(seed)
    return tuple(
        rng.integers(0, [camera.rows, camera.cols], (number, 2)).astype(np.float64)
        for camera in (rig.camera1, rig.camera2)
    )
