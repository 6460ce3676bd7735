"""The machine: geometry, timing and sensor, and the layout of frames in memory."""

from npchip.machine.model import (
    BUILTIN,
    PIXELS,
    Cost,
    Link,
    Machine,
    Sensor,
    load_machine,
    parse_machine,
)

__all__ = [
    "BUILTIN",
    "PIXELS",
    "Cost",
    "Link",
    "Machine",
    "Sensor",
    "load_machine",
    "parse_machine",
]
