"""Sources of frames: arrays, image files and videos."""

from npchip.frames.arrays import frames_from_array, frames_from_iterable
from npchip.frames.fit import Fit
from npchip.frames.open import open_frames
from npchip.frames.source import FrameSource

__all__ = ["Fit", "FrameSource", "frames_from_array", "frames_from_iterable", "open_frames"]
