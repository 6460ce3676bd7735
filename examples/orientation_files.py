"""Make the files of examples/orientation: pictures with their poses, frames and weights.

    python examples/orientation_files.py [FOLDER]       (needs the extra `orient`)

The pictures are for ``npchip orient predict``, the frames and weights for ``asm/orientation.s`` on
the default machine (64 x 80 pixels) and on ``uav.yaml`` beside them: 13 x 13 NPs, the smallest
array that holds the thesis's 100 x 100 pixels. Its last four rows and columns are background.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from PIL import Image

from examples.target import asked
from npchip.host.vision.orientation import dataset, eightbit, pictures
from npchip.host.vision.orientation.network import split
from npchip.host.vision.orientation.scene import CHIP, THESIS, random_positions, yaw_and_pitch

FOLDER = Path(__file__).parent / "orientation"
SEED = 1
"""Seed of the networks; those that come with the package have the same."""

POSES_SEED = 7
"""Seed of poses that no network has seen."""

ARRAYS = {"100x100": (THESIS, (13, 13)), "64x80": (CHIP, (8, 10))}


def main(folder: Path) -> None:
    """Write all files into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for size, (camera, array) in ARRAYS.items():
        positions = random_positions(8, POSES_SEED, camera)
        np.save(folder / f"frames-{size}.npy", padded(pictures.render(positions, camera), array))
        data = dataset.make(dataset.Settings(camera=camera))
        network = eightbit.train_chip(data, split(len(data), SEED), seed=SEED)
        eightbit.save(folder / f"chip-{size}.json", network)
        eightbit.save_planes(folder / f"weights-{size}.npy", network, *array)
    write_pictures(folder)


def padded(frames: pictures.Pictures, array: tuple[int, int]) -> pictures.Pictures:
    """Add background below and to the right, up to the size of an array of NPs."""
    rows, cols = (8 * number for number in array)
    room = ((0, 0), (0, rows - frames.shape[1]), (0, cols - frames.shape[2]))
    return np.pad(frames, room, constant_values=pictures.BACKGROUND)


def write_pictures(folder: Path) -> None:
    """Write six pictures, and a table of their angles and true positions."""
    positions = random_positions(6, POSES_SEED)
    with (folder / "angles.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["name", "yaw", "pitch", "x", "y", "z"])
        for number, (picture, direction, place) in enumerate(
            zip(pictures.render(positions), yaw_and_pitch(positions), positions, strict=True)
        ):
            name = f"shot{number}.png"
            Image.fromarray(picture).save(folder / name)
            angles = [f"{angle:.2f}" for angle in direction]
            table.writerow([name, *angles, *(f"{value:.0f}" for value in place)])


if __name__ == "__main__":
    main(asked(FOLDER))
