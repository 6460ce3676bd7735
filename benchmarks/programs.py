"""The measured programs: those of ``asm/``, a clip, and a chip that can run any of them.

Uses nothing but the public names of npchip, so that it serves other commits of the package too.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from npchip import Chip, Program

ROOT: Final = Path(__file__).parents[1]
CLIP: Final = ROOT / "examples" / "clips" / "coin_slide.npy"
FRAMES: Final = 6_000


def sources(tree: Path = ROOT) -> dict[str, Path]:
    """Return the programs of a tree's ``asm/``, by name."""
    return {path.stem: path for path in sorted((tree / "asm").glob("*.s"))}


def long_clip() -> NDArray[np.uint8]:
    """Return the clip again and again, `FRAMES` frames of it."""
    clip = np.load(CLIP)
    return np.concatenate([clip] * (FRAMES // len(clip)))


def made(program: Program, **options: Any) -> Chip:
    """Make a chip whose partner, which few programs ask, sends the same in every frame."""
    chip = Chip(program, **options)
    chip.connect(lambda _: np.full((8, 10), 40, np.uint8))
    return chip
