"""The ball of the examples, before both cameras of the chip's rig."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from npchip.host.scenes.stereo import read_space_scene, render_pair
from npchip.host.vision.fusion import load_rig

RIGS = Path(__file__).parents[3] / "examples" / "rigs"
RIG = load_rig(RIGS / "chip.yaml")
SCENE = read_space_scene(RIGS / "ball.yaml")
Bytes = NDArray[np.uint8]


def clips(frames: int = 40) -> tuple[Bytes, Bytes]:
    """Return what both cameras see: uint8, shape (frames, 64, 80)."""
    one, two = (view.clip[:frames] for view in render_pair(SCENE, RIG))
    return one, two
