"""Second-order prediction on real clips, drawn by npchip itself.

    python -m examples.trajectory_clips [FOLDER]

Writes what ``npchip run asm/trajectory_nonlinear.s --render`` draws of two clips: the picture that
the program sends, with the predicted pixel in it, under the past path and the prediction.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from examples.target import asked

ROOT = Path(__file__).parents[1]
CLIPS = ("coin_slide", "mouse_run")


def main(folder: Path) -> None:
    """Write a picture of each clip into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for clip in CLIPS:
        command = [sys.executable, "-m", "npchip", "run", str(ROOT / "asm/trajectory_nonlinear.s")]
        command += ["--frames", str(ROOT / f"examples/clips/{clip}.npy")]
        command += ["--render", str(folder / f"nonlinear-{clip}.png")]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(asked(ROOT / "docs" / "figures"))
