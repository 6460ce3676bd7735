"""The public chip, which runs programs on frames, and its results."""

from npchip.run.chip import Chip, Snapshot
from npchip.run.result import RunResult

__all__ = ["Chip", "RunResult", "Snapshot"]
