"""Two emulated chips as one camera system (thesis 4.1.1).

from npchip.host.rig import watch
from npchip.host.vision.fusion import load_rig

seen = watch(load_rig("chip"), left, right)   # clips, uint8 (T, 64, 80)
seen.positions.points                                            # metres, (T, 3)
seen.timings["serial"].latency, seen.timings["serial"].limit     # cycles, (T,); slowest part
"""

from npchip.host.rig.array import ON_ARRAY, definitions, entries
from npchip.host.rig.links import LINKS, Timing, transfer_cycles
from npchip.host.rig.system import WINDOW, Observation, watch

__all__ = [
    "LINKS",
    "ON_ARRAY",
    "WINDOW",
    "Observation",
    "Timing",
    "definitions",
    "entries",
    "transfer_cycles",
    "watch",
]
