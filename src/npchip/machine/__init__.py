"""The machine: its geometry, timing and sensor, and how frames lie in its memories."""

from npchip.machine.layout import PIXELS, to_frames, to_planes
from npchip.machine.model import BUILTIN, Link, Machine, Sensor, load_machine
from npchip.machine.sensor import SensorModel

__all__ = [
    "BUILTIN",
    "PIXELS",
    "Link",
    "Machine",
    "Sensor",
    "SensorModel",
    "load_machine",
    "to_frames",
    "to_planes",
]
