"""The engines that execute programs."""

from npchip.engines.base import Engine, Feed, Stop, TrapError
from npchip.engines.reference import ReferenceEngine
from npchip.engines.state import ChipState, RawFrame, Send

__all__ = [
    "ChipState",
    "Engine",
    "Feed",
    "RawFrame",
    "ReferenceEngine",
    "Send",
    "Stop",
    "TrapError",
]
