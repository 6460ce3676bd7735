"""The chip at work: programs run on frames, and what they yield."""

from npchip.run.chip import Chip, Snapshot
from npchip.run.result import RunResult

__all__ = ["Chip", "RunResult", "Snapshot"]
