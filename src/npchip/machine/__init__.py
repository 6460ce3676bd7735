"""The machine: its geometry, timing and sensor, and how frames lie in its memories."""

from npchip.machine.model import BUILTIN, PIXELS, Link, Machine, Sensor, load_machine

__all__ = [
    "BUILTIN",
    "PIXELS",
    "Link",
    "Machine",
    "Sensor",
    "load_machine",
]
