"""A rig for `asm/fusion_lut.s`: constants, and the table in the NPs' memories."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip import bundle
from npchip.base.errors import InputError
from npchip.host.vision.fusion import ALGORITHMS, CHIP, Rig, build_table
from npchip.host.vision.fusion.registry import find
from npchip.machine import PIXELS, Machine

ON_ARRAY: Final = {"improved-2n": 0, "keep-y": 1, "extra-step": 2}
"""Algorithms of `npchip.host.vision.fusion` that the array computes, with their `ROUNDS`."""

ENTRIES: Final = 192
"""First address of the table in an NP's memory."""

_BIAS = 1 << (CHIP.word_bits - 1)
_ENTRY = 6
_LARGEST_SHIFT = 14


def program_path(name: str) -> Path:
    """Return the path of a bundled program, such as ``"tracking"``.

    Raises:
        InputError: NP521, there is no such file.
    """
    found = bundle.bundled("program").get(name)
    if found is None:
        message = f"{name}.s is not there: this npchip was installed without its programs"
        raise InputError("NP521", message)
    return found.path


def definitions(rig: Rig, algorithm: str = "improved-2n") -> dict[str, int]:
    """Compute the constants of `asm/fusion_lut.s` for a rig.

    Args:
        rig: the cameras; both ratios the same power of two, positions within ±8 m.
        algorithm: a key of `ON_ARRAY`.

    Returns:
        the ``defines`` for `npchip.assemble`.

    Raises:
        InputError: NP505, there is no such algorithm; NP522, the array cannot compute this, for the
            reason in the message.
    """
    if algorithm not in ALGORITHMS:
        find(algorithm, rig)
    if algorithm not in ON_ARRAY:
        raise _cannot(
            f"{algorithm} is not among the algorithms that the array computes",
            f"these are {', '.join(ON_ARRAY)}; --link host takes every one",
        )
    first, second = rig.camera1, rig.camera2
    for number, camera in ((1, first), (2, second)):
        if any(camera.turned):
            raise _cannot(
                f"camera{number} is turned, and the array takes cameras that stand straight",
                "leave it to a processor: --link host",
            )
    if first.shift is None or first.shift > _LARGEST_SHIFT or first.ratio != second.ratio:
        raise _cannot(
            f"ratios of {first.ratio:g} and {second.ratio:g} pixels: the array shifts instead of"
            f" dividing, so both must be the same power of two, up to {2**_LARGEST_SHIFT}",
            "set the ratio by the focal length, or leave it to a processor: --link host",
        )
    constants = {
        f"{axis.upper()}{number}": _word(value, f"camera{number}: {axis} =")
        for number, camera in ((1, first), (2, second))
        for axis, value in zip("xyz", camera.position, strict=True)
    }
    del constants["Z2"]  # which the algorithm does not use
    return constants | {"SHIFT": first.shift, "UP": first.sign, "ROUNDS": ON_ARRAY[algorithm]}


def _word(metres: float, what: str) -> int:
    raw: int = round(metres * 2**CHIP.fraction_bits)
    if not -_BIAS <= raw < _BIAS:
        reach = _BIAS >> CHIP.fraction_bits
        raise _cannot(
            f"{what} {metres:g} m does not fit in a word: the array reaches ±{reach} m",
            "move the origin between the cameras, or leave it to a processor: --link host",
        )
    return raw


def entries(rig: Rig, machine: Machine) -> NDArray[np.uint8]:
    """Spread the lookup table of a rig over the memories of the NPs.

    NP (j mod NP rows, i) has the entry of column i of camera 1 and column j of camera 2; it has
    several entries if camera 2 has more columns than the array has rows.

    Args:
        rig: the cameras.
        machine: machine of the array, of at most 10 x 10 NPs.

    Returns:
        uint8, shape (6 for each entry, NP rows, NP columns), for `Chip.load_memory` at `ENTRIES`:
        x, then y, in Q12 + 32768, low byte first, each with a byte that is 1 without a value.

    Raises:
        InputError: NP523, the cameras and the array differ in size.
    """
    check_sizes(rig, machine)
    table = build_table(rig)
    usable = table.status == 0
    slots = -(-machine.np_cols // machine.np_rows)
    planes = np.zeros((slots, _ENTRY, *machine.geometry), np.uint8)
    for which, values in enumerate((table.x, table.y)):
        scaled = np.floor(np.where(usable, values, 0) * 2**CHIP.fraction_bits + 0.5)
        fits = usable & (scaled >= -_BIAS) & (scaled < _BIAS)
        raw = np.where(fits, scaled, 0).astype(np.int64) + _BIAS
        parts = np.stack([raw & 0xFF, raw >> 8, ~fits]).astype(np.uint8)
        for j in range(machine.np_cols):
            slot, row = divmod(j, machine.np_rows)
            planes[slot, 3 * which : 3 * which + 3, row] = parts[:, :, j]
    return planes.reshape(-1, *machine.geometry)


def check_sizes(rig: Rig, machine: Machine) -> None:
    """Refuse a rig whose cameras do not have the size of the machine.

    Raises:
        InputError: NP523.
    """
    for number, camera in ((1, rig.camera1), (2, rig.camera2)):
        if (camera.rows, camera.cols) != (machine.rows, machine.cols):
            raise InputError(
                "NP523",
                f"camera{number} of the rig has {camera.rows} x {camera.cols} pixels, but machine"
                f" {machine.name} has {machine.rows} x {machine.cols}",
                hint="set rows and cols in the rig file, or take another machine",
            )
    if rig.cell != PIXELS:
        raise InputError(
            "NP523",
            f"the rig's cell has {rig.cell} pixels, but an NP has {PIXELS}",
            hint=f"leave cell out, or set it to {PIXELS}",
        )


def _cannot(reason: str, hint: str) -> InputError:
    return InputError("NP522", reason, hint=hint)
