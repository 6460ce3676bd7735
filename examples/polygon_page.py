"""Measure how well polygons.s tells convex shapes apart, and write docs/polygons.md.

    python -m examples.polygon_page [FILE]

Rates are those of the sweeps ``outlines.yaml``, ``nested.yaml`` and ``signs.yaml``, which run here
and take some minutes. The same figures come out on every computer.
"""

from __future__ import annotations

from textwrap import fill

import numpy as np
from click.testing import CliRunner

from examples.keypoint_page import cell
from examples.measure import MACHINES, ROOT, run, swept, table, write_page
from examples.sweeps.outlines import NESTED, SHAPES, SIGNS, disc_corners
from npchip import Chip, assemble, load_machine
from npchip.cli.main import cli
from npchip.host.vision.polygons import random_regular_polygon, raster

SIDES = (3, 4, 5, 6, 8)
RADII = (6, 8, 10, 12, 14, 16, 18, 20, 24, 28)
SETS = 5
TIMED = 100

TEXT = """\
# Polygons, measured

Use `polygons.s` to tell squares, pentagons, octagons and STOP signs from triangles: it finds blunt
corners, and shapes within shapes. `python -m examples.polygon_page` measures the figures; rates are
means over {sets} sets ± their standard deviation, from the sweeps in
[`examples/sweeps`](../examples/sweeps). `npchip.host.vision.outlines` explains the rules;
`asm/polygons.s` computes exactly that on the array, in {words} words.

```console
$ npchip run asm/polygons.s --frames examples/clips/shapes_drawn.npy --define DARK=1
{shown}
...
```

For each object the program sends the number of its corners, whether it is `regular` (sides of about
one length, angles of about one width), and their places. So 3 is a triangle, 4 and regular a
square, 8 and regular a STOP sign.

![Outlines that polygons.s finds](figures/outlines.svg)

*What `polygons.s` finds on the emulated chip: a ring with a square in it, a STOP sign before trees,
one before the sky, and an octagon that is not regular. Crosses are the true corners.*

## Which program

| | [`keypoints.s`](keypoints.md), `recognise.s` | `polygons.s` |
| --- | --- | --- |
| finds corners by | the steps along an edge | the pixels farthest from a side |
| shapes | any, with dents and holes | convex; dents and holes do not show |
| corners of 135° | many are missed | found |
| what lies in a hole | is not seen | is an object of its own |
| a pixel that stands out by one | can be a corner | is none |

## Corners

{sets} sets of {shapes} polygons of each kind. *Convex* ones have sides of 12 pixels or more, no
angle below 20° or above 160°, and measure 40 to 60 pixels across; *regular* ones have a radius of
10 to 30.

{corners}

`keypoints.s` and *exactly*: exactly as many corners as the polygon has; *fewer*, *more*: of
`polygons.s`; *≤ 3*: all corners within 3 pixels of the true ones; *regular*: sent as 1, of those
with exactly their corners. Two corners within `MERGE`, 4, rows and columns become one, so octagons
with a radius below 10 pixels lose some.

**A disc is no polygon, but looks like one.** Its outline has an octagon's corners where the octagon
lies within `TOLERANCE` of it:

{discs}

## A ring with a square in it

{nested}

## STOP signs

{sets} sets of {signs} signs for each row, 30 to 56 pixels across, turned away by up to 30° and by
up to 10° in the picture, drawn with the sizes of the sign R1-1 of the MUTCD with its border and
letters. They run on the emulated chip; noise is that of one conversion. Before trees (`THRESHOLD`
90) the object is the thin white border, before the sky (`THRESHOLD` 128, `DARK` 1) the red octagon,
with letters for holes.

{signs_found}

*octagon*: exactly one object of the frame has 8 corners, all within 3 pixels of the sign's; *STOP*:
and it is regular; *`keypoints.s`*: exactly one object has 8 key points. Noise tears the border,
which is hardly more than a pixel wide. The signs are drawn: no photograph with a licence to ship
was at hand.

## Cycles

Regular polygons, {timed} of each number of sides, one in a frame, with imaging and double sampling:

{cycles}

The chip takes an object out of the frame by growing it from its first pixel, then searches once for
each corner and each side, and again in each of two rounds. Objects too thin to have three corners
take about 1,000 cycles each, so noise of single pixels is costly: up to {budget} cycles in the
worst frame, a chessboard.
"""


def shown() -> str:
    """Return what ``npchip run`` prints of the frames of a clip."""
    frames = str(ROOT / "examples" / "clips" / "shapes_drawn.npy")
    program = str(ROOT / "asm" / "polygons.s")
    done = CliRunner().invoke(cli, ["run", program, "--frames", frames, "--define", "DARK=1"])
    assert done.exit_code == 0, done.output
    return "\n".join(done.stdout.splitlines()[:5])


def corners() -> str:
    """Tabulate how often the corners of polygons are found."""
    rows = []
    for kind in ("convex", "regular"):
        for sides in SIDES:
            found = swept("outlines", kind=kind, sides=sides)
            names = ("tracer", "outline", "fewer", "more", "within_3", "regular")
            rows.append([f"{kind}, {sides}", *(cell(found[name]) for name in names)])
    head = ["polygon, sides", "`keypoints.s`", "exactly", "fewer", "more", "≤ 3", "regular"]
    return table(head, rows, 6)


def discs() -> str:
    """Tabulate the corners of discs."""
    counts = [f"{disc_corners(radius)}" for radius in RADII]
    return table(["radius, pixels", *map(str, RADII)], [["corners", *counts]], len(RADII))


def nested() -> str:
    """Say how often a ring with a square in it is two objects."""
    found = swept("nested")
    return fill(
        f"{SETS} sets of {NESTED} rings with 4 to 8 sides, a square in each. They are two objects"
        f" in {cell(found['outline'])} of the frames, with exactly the corners of both in"
        f" {cell(found['corners'])}. To the tracer of `keypoints.s` they are two in"
        f" {cell(found['tracer'])}.",
        100,
    )


def signs() -> str:
    """Tabulate how often STOP signs are found."""
    rows = []
    for ground in ("trees", "sky"):
        for noise, found in swept("signs", ground=ground).groupby("noise_rms"):
            names = ("tracer", "octagon", "stop")
            rows.append([f"{ground}", f"{noise:g}", *(cell(found[name]) for name in names)])
    return table(["before", "noise, LSB rms", "`keypoints.s`", "octagon", "STOP"], rows, 4)


def cycles() -> str:
    """Tabulate the cycles of a frame by the number of sides."""
    rows = []
    for sides in SIDES:
        rng = np.random.default_rng(sides)
        masks = [raster(random_regular_polygon(rng, sides)) for _ in range(TIMED)]
        frames = np.where(np.array(masks), 200, 30).astype(np.uint8)
        row = [f"{sides}"]
        for name in MACHINES:
            machine = load_machine(name)
            program = assemble(ROOT / "asm" / "polygons.s", machine)
            taken = Chip(program, machine).run(frames).frame_cycles
            row += [f"{taken.mean():,.0f}", f"{taken.max():,}"]
        rows.append(row)
    head = [f"{machine}, {what}" for machine in MACHINES for what in ("mean", "most")]
    return table(["sides", *head], rows, 4)


def document() -> str:
    """Return the text of docs/polygons.md."""
    program = run("polygons").program
    assert program.budget.cycles
    return TEXT.format(
        sets=SETS,
        shapes=SHAPES,
        signs=SIGNS,
        timed=TIMED,
        words=len(program.words),
        shown=shown(),
        corners=corners(),
        discs=discs(),
        nested=nested(),
        signs_found=signs(),
        cycles=cycles(),
        budget=f"{program.budget.cycles:,}",
    )


if __name__ == "__main__":
    write_page("polygons.md", document)
