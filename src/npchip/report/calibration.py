"""Turned cameras, as text and JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from npchip.base.columns import aligned
from npchip.host.vision.fusion.rigfile import rig_as_data, rig_text
from npchip.report.jsonform import to_text

if TYPE_CHECKING:
    from npchip.host.vision.fusion import Calibration

SCHEMA: Final = 1
HEADER: Final = ("camera", "points", "right", "up", "clockwise", "before", "after")


def plain_text(found: Calibration) -> str:
    """Return a table, with the rig file; other lines start with ``#``."""
    cameras = found.rig.camera1, found.rig.camera2
    rows = [
        (
            str(k + 1),
            str(found.points[k]),
            *(f"{angle:.2f}" for angle in camera.turned),
            f"{found.before[k]:.2f}",
            f"{found.after[k]:.2f}",
        )
        for k, camera in enumerate(cameras)
    ]
    about = "turned by degrees; points are seen this many pixels (RMS) from where they should be"
    notes = [f"# {line}" for line in (about, *rig_text(found.rig).splitlines())]
    return "\n".join([*aligned([HEADER, *rows], left=0), *notes, ""])


def json_text(found: Calibration) -> str:
    """Return the document of ``docs/rig.md``."""
    return to_text(
        {
            "schema": SCHEMA,
            "points": list(found.points),
            "before": list(found.before),
            "after": list(found.after),
            "rig": rig_as_data(found.rig),
        }
    )
