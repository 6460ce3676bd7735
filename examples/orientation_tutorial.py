"""From a picture to a position: how a drone finds out where it is.

    python examples/orientation_tutorial.py

Reads like a tutorial: seven steps, each with what it prints. Thesis 3.4 is the source of the idea;
docs/orientation.md says how well it works.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from npchip import Chip, assemble, load_machine
from npchip.host.vision.orientation import eightbit, models, predict
from npchip.host.vision.orientation.corners import vertices
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import (
    cartesian,
    polar_and_azimuth,
    spherical,
    yaw_and_pitch,
)

EXAMPLES = Path(__file__).parent
FILES = EXAMPLES / "orientation"

# 1. A drone hovers in a room. On the floor lies a right triangle with legs of 250 and 600 mm, one
#    corner of it brighter than the rest. The drone does not know where it is; we do.
drone = np.array([[900.0, 250.0, 1400.0]])  # x, y, z in mm
print("the drone is at", drone[0])

# 2. It turns its camera to the middle of the triangle. Its compass and the hinge of the camera then
#    tell it the direction in which it looks.
directions = yaw_and_pitch(drone)
print("it looks to yaw {:.1f}°, pitch {:.1f}°".format(*directions[0]))

# 3. The camera takes a picture of 100 x 100 pixels: how much of each pixel the triangle covers.
picture = render(drone)[0]
print("the picture has levels from", picture.min(), "to", picture.max())

# 4. The key points of the picture are the corners of the triangle. The bright one comes first, the
#    others anticlockwise, so that the sides are not mistaken for each other.
corners = vertices(picture)
print("corners (row, column):", *corners.tolist())

# 5. The farther away the camera is, the shorter are the sides, and the more it looks from the side,
#    the more their ratios change. A network with 15 neurons has learned how far away a triangle
#    with such sides is.
sides = models.side_lengths(corners[np.newaxis])
network = predict.bundled("hybrid", "100x100").network
radial = network(sides)[0, 0]
print("sides of", sides[0].round(1), f"pixels: about {radial:.0f} mm away")
print(f"it is {spherical(drone)[0, 0]:.0f} mm")

# 6. How far, and in which direction: that is a position.
polar, azimuth = polar_and_azimuth(directions)[0]
found = cartesian(np.array([[radial, polar, azimuth]]))[0]
print("so the drone is at", found.round(), f"- {np.linalg.norm(found - drone[0]):.0f} mm wrong")

# 7. The chip does all of this up to the distance itself, in one program: the picture is taken by an
#    array of 13 x 13 NPs, and 15 of these are the neurons, with weights of 8 bits.
machine = load_machine(FILES / "uav.yaml")
chip = Chip(assemble(EXAMPLES.parent / "asm" / "orientation.s", machine), machine)
chip.load_memory(eightbit.ADDRESS, np.load(FILES / "weights-100x100.npy"))
frame = np.pad(picture, ((0, 4), (0, 4)), constant_values=picture.min())
result = chip.run(frame)
print("the chip says", result.value("distance", 0), "mm, in", result.frame_cycles[0], "cycles")
