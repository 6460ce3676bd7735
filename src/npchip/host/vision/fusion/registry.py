"""The algorithms by name, with their figures in the thesis and their operations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from npchip.base.errors import InputError
from npchip.host.vision.fusion.algorithms import (
    Constants,
    Core,
    Sight,
    improved_2n,
    improved_dx,
    improved_fdx,
    lookup,
    similarity,
    vector,
)
from npchip.host.vision.fusion.arithmetic import Counting
from npchip.host.vision.fusion.beyond import extra_step, keep_y, midpoint, reprojection
from npchip.host.vision.fusion.camera import Rig


@dataclass(frozen=True)
class Algorithm:
    """An algorithm from four offsets to a position.

    Attributes:
        title: title in tables.
        core: the computation.
        table: coordinates of the lookup table that it reads, such as ``"xy"``.
        power: whether the ratios must be powers of two.
        integers: whether it can compute in Q format.
        thesis: multiplications, divisions and RMS in metres of table 2.1; None for a decision of
            this project.
    """

    title: str
    core: Core
    table: str = ""
    power: bool = False
    integers: bool = True
    thesis: tuple[int, int, float] | None = None


ALGORITHMS: Final[Mapping[str, Algorithm]] = {
    "vector": Algorithm("vector-based", vector, thesis=(6, 2, 0.0199)),
    "similarity": Algorithm("similarity triangle", similarity, thesis=(4, 4, 0.0176)),
    "lut": Algorithm("lookup table", lookup, "xyz", thesis=(0, 0, 0.2924)),
    "improved-dx": Algorithm("improved, dx", improved_dx, "xy", thesis=(5, 3, 0.0431)),
    "improved-fdx": Algorithm("improved, fdx", improved_fdx, "xy", thesis=(3, 3, 0.0487)),
    "improved-2n": Algorithm("improved, 2ⁿ", improved_2n, "xy", power=True, thesis=(3, 0, 0.0487)),
    "keep-y": Algorithm("keep y, 2ⁿ", keep_y, "y", power=True),
    "extra-step": Algorithm("extra step, 2ⁿ", extra_step, "y", power=True),
    "midpoint": Algorithm("midpoint", midpoint, integers=False),
    "reprojection": Algorithm("reprojection", reprojection, integers=False),
}
"""Algorithms by their names in `locate` and on the command line."""


def find(name: str, rig: Rig) -> Algorithm:
    """Return the algorithm `name`, if it can run on the rig.

    Raises:
        InputError: NP505, there is no such algorithm; NP506, it needs ratios that are powers of
            two.
    """
    if name not in ALGORITHMS:
        raise InputError(
            "NP505",
            f"there is no algorithm '{name[:40]}'",
            hint=f"the algorithms are {', '.join(ALGORITHMS)}",
        )
    algorithm = ALGORITHMS[name]
    for number, camera in enumerate((rig.camera1, rig.camera2), 1):
        if algorithm.power and camera.shift is None:
            raise InputError(
                "NP506",
                f"{name} shifts instead of dividing: the ratio of camera{number} must be a power"
                f" of two, found {camera.ratio:g}",
                hint="set the ratio by the focal length, or take improved-fdx",
            )
    return algorithm


def count(name: str, rig: Rig) -> dict[str, int] | None:
    """Count the operations of one position, by running the algorithm on counting numbers.

    Args:
        name: a key of `ALGORITHMS`.
        rig: the cameras.

    Returns:
        additions (and subtractions), multiplications, divisions, shifts and comparisons; None for
        an algorithm that iterates or solves equations.

    Raises:
        InputError: as `find`.
    """
    algorithm = find(name, rig)
    if not algorithm.integers:
        return None
    m = Counting()
    numbers = {key: m.constant(1.5) for key in Sight.__dataclass_fields__}
    algorithm.core(m, Constants(m, rig), Sight(**numbers))
    kinds = ("additions", "multiplications", "divisions", "shifts", "comparisons")
    return {kind: m.counts[kind] for kind in kinds}
