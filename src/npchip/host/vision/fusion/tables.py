"""The lookup tables of thesis 2.2.3: positions of the middles of all pairs of cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.fusion.arithmetic import QFormat
from npchip.host.vision.fusion.camera import Floats, Rig
from npchip.host.vision.fusion.status import Status, crossing


@dataclass(frozen=True, eq=False)
class LookupTable:
    """Positions for pairs of cells; n1, n2 columns of cells of camera 1 and 2, m rows of camera 1.

    Cells are numbered as in the frame, columns to the right and rows downwards, from 0. In the
    thesis's words x and y are "two two-input lookup tables" of n² entries; z, which the thesis
    leaves open, takes three inputs (decision), and only the plain table algorithm reads it.

    Attributes:
        x, y: float64, shape (n1, n2), metres.
        z: float64, shape (n1, n2, m), metres.
        status: uint8, shape (n1, n2): `Status` of the entry, 0 where it can be used.
    """

    x: Floats
    y: Floats
    z: Floats
    status: NDArray[np.uint8]

    def integers(self, form: QFormat) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return x and y in Q format, rounded halves up, int64 (n1, n2); 0 where unusable."""
        scale = 2**form.fraction_bits
        usable = self.status == Status.OK
        return tuple(  # type: ignore[return-value]  # two in, two out
            np.where(usable, np.floor(values * scale + 0.5), 0).astype(np.int64)
            for values in (self.x, self.y)
        )


def middles(rig: Rig) -> tuple[Floats, Floats, Floats]:
    """Offsets h1, h2 and v1 of the middles of the cells: shapes (n1,), (n2,), (m,)."""
    n1, n2, m = rig.cells
    at = [(np.arange(n) + 0.5) * rig.cell - 0.5 for n in (n1, n2, m)]
    row = np.zeros(1)
    h1, _ = rig.camera1.offsets(np.stack(np.broadcast_arrays(row, at[0]), -1))
    h2, _ = rig.camera2.offsets(np.stack(np.broadcast_arrays(row, at[1]), -1))
    _, v1 = rig.camera1.offsets(np.stack(np.broadcast_arrays(at[2], row), -1))
    return h1, h2, v1


def build_table(rig: Rig) -> LookupTable:
    """Compute the tables of a rig; entries whose rays do not meet in front of both are marked."""
    h1, h2, v1 = middles(rig)
    meet = crossing(rig, h1[:, None], h2[None, :])
    y, x = meet.y, meet.x
    z = rig.camera1.position[2] + (y - rig.camera1.position[1])[:, :, None] * v1 / rig.camera1.ratio
    return LookupTable(x, y, z, meet.status)
