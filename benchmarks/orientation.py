"""Orientation: training, a thousand pictures, and the program on both arrays."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from benchmarks.measure import processor_time
from npchip import Chip, assemble, load_machine
from npchip.host.vision.orientation import dataset, models, predict
from npchip.host.vision.orientation.network import split
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import random_positions, yaw_and_pitch

ROOT: Final = Path(__file__).parents[1]
FILES: Final = ROOT / "examples" / "orientation"
PICTURES: Final = 1_000


def orientation() -> dict[str, dict[str, float]]:
    """Seconds of processor time."""
    data = dataset.make(dataset.Settings())
    parts = split(len(data), 0)
    table = {
        "data set, 4,000 pictures": lambda: dataset.make(dataset.Settings()),
        "train hybrid once": lambda: models.train_model("hybrid", data, parts),
    }
    found = {name: {"s": processor_time(work, 1)} for name, work in table.items()}
    positions = random_positions(PICTURES, 12)
    with tempfile.TemporaryDirectory() as folder:
        for number, picture in enumerate(render(positions)):
            Image.fromarray(picture).save(Path(folder) / f"{number}.png")
        files = predict.pictures(Path(folder))
        angles = yaw_and_pitch(positions).tolist()
        directions = {f"{k}.png": (yaw, pitch) for k, (yaw, pitch) in enumerate(angles)}
        estimator = predict.bundled("hybrid", "100x100")
        seconds = processor_time(lambda: predict.predict(estimator, files, directions), 1)
    found["predict, 1,000 files"] = {"s": seconds}
    for size, name in (("64x80", "default"), ("100x100", str(FILES / "uav.yaml"))):
        machine = load_machine(name)
        chip = Chip(assemble(ROOT / "asm" / "orientation.s", machine), machine)
        frames = np.concatenate([np.load(FILES / f"frames-{size}.npy")] * 125)

        def run(chip: Chip = chip, frames: np.ndarray = frames) -> None:
            chip.run(frames)

        found[f"orientation.s, 1,000 frames {size}"] = {"s": processor_time(run)}
    return found
