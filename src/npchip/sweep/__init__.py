"""Sweeps: a file of axes, one command, and one table with a row for every run.

from npchip import sweep

table = sweep.load("thresholds.yaml").run(jobs=2)
"""

from npchip.sweep.sweep import Outcome, Sweep, load

__all__ = ["Outcome", "Sweep", "load"]
