"""Poses on which small networks are trained, made once."""

from __future__ import annotations

from functools import cache

from npchip.host.vision.orientation import dataset
from npchip.host.vision.orientation.dataset import DataSet, Settings, Source
from npchip.host.vision.orientation.network import Split, split


@cache
def data_set(poses: int = 600, source: Source = "rendered") -> DataSet:
    return dataset.make(Settings(poses=poses, source=source))


@cache
def parts() -> Split:
    return split(600, 0)
