"""The engines that execute programs."""

from npchip.engines.base import Engine, Feed, Partner, Request, Sink, Stop, TrapError
from npchip.engines.batch import FrameBatch
from npchip.engines.counts import Counts
from npchip.engines.reference import ReferenceEngine
from npchip.engines.state import ChipState, RawFrame, Send, Write

__all__ = [
    "ChipState",
    "Counts",
    "Engine",
    "Feed",
    "FrameBatch",
    "Partner",
    "RawFrame",
    "ReferenceEngine",
    "Request",
    "Send",
    "Sink",
    "Stop",
    "TrapError",
    "Write",
]
