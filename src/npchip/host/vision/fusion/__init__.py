"""Two cameras, one position in space (thesis 2.2): cameras, the algorithms of table 2.1, and more.

from npchip.host.vision.fusion import load_rig, locate

rig = load_rig("thesis")
found = locate(rig, seen1, seen2, "improved-2n")    # (row, column) in both cameras, (..., 2)
found.points, found.status                          # metres (..., 3); marks (...)
"""

from npchip.host.vision.fusion.arithmetic import CHIP, Q12, QFormat
from npchip.host.vision.fusion.beyond import PathFit, fit_path, predict
from npchip.host.vision.fusion.calibrate import Calibration, calibrate
from npchip.host.vision.fusion.camera import Camera, Rig, calibrate_ratio, distance_from_area
from npchip.host.vision.fusion.crossing import LookupTable, Status, apart, build_table
from npchip.host.vision.fusion.locate import Positions, locate, needed_bits
from npchip.host.vision.fusion.registry import ALGORITHMS, count
from npchip.host.vision.fusion.rigfile import load_rig

__all__ = [
    "ALGORITHMS",
    "CHIP",
    "Q12",
    "Calibration",
    "Camera",
    "LookupTable",
    "PathFit",
    "Positions",
    "QFormat",
    "Rig",
    "Status",
    "apart",
    "build_table",
    "calibrate",
    "calibrate_ratio",
    "count",
    "distance_from_area",
    "fit_path",
    "load_rig",
    "locate",
    "needed_bits",
    "predict",
]
