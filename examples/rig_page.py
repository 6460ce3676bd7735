"""Run the two cameras of examples/rigs on both machines; write docs/rig.md and its picture.

python -m examples.rig_page [FILE]
"""

from __future__ import annotations

from functools import cache

import numpy as np

from examples.measure import MACHINES, ROOT, run, swept, table, write_page
from examples.rig_tables import (
    BLANK,
    RIG,
    RIGS,
    calibration_verdict,
    following,
    shown,
    turned_cameras,
)
from examples.sweeps.calibration import PATHS
from npchip import load_machine
from npchip.frames import open_frames
from npchip.host.rig import WINDOW, Observation, transfer_cycles, watch
from npchip.host.scenes.stereo import read_space_scene, render_pair
from npchip.host.vision.fusion import locate
from npchip.report.rig import plain_text
from npchip.report.space import draw
from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ, Clock

PICTURE = RIG.camera1.rows * RIG.camera1.cols

TEXT = """\
# Two chips, one camera system

Run two emulated chips as one camera system, and find out which link limits its frame rate.
`python -m examples.rig_page` measures the figures.

Two cameras that locate an object in space need a link; the thesis (4.1.1) leaves it to future work.
It names a serial link, which "significantly reduces the overall processing speed"; a parallel one;
and a separate processor, with "a low transmission efficiency but a high processing speed". `npchip
fuse` runs two emulated chips on two clips and counts the cycles of all three:

```console
$ npchip fuse examples/rigs/ball.1.gif examples/rigs/ball.2.gif --rig examples/rigs/chip.yaml
{first}
...
```

`row1`, `col1`, `row2`, `col2` are the middle of the object's box in each camera, in half
pixels; x, y, z are metres; `cycles` is the time from the exposure to the position. If a frame has
no position, its `mark` says why, and the run goes on. `--plot FILE.svg` (or `.png`) draws the path:

![The path of the ball and the two cameras](figures/rig.svg)

## Who does what

- **Camera 2** runs [`asm/sighting.s`](../asm/sighting.s). It finds the object by its brightness
  (`--threshold`, `--dark`), as `tracking.s` does, and sends whether there is one and first +
  last row and column of its box.
- **Camera 1** runs [`asm/fusion_lut.s`](../asm/fusion_lut.s). It does the same, and then uses the
  improved lookup table of thesis 2.2.4 with shifts for divisions, in {words} words. The table is
  spread over the NPs' memories: columns i of camera 1 and j of camera 2 meet in NP (j mod 8, i),
  and only that NP goes on and sends. `--algorithm` takes `improved-2n`, `keep-y` and `extra-step`;
  x, y and z equal those of the host's library in integers (`locate(..., CHIP)`,
  [fusion.md](fusion.md)) bit for bit.
- With **a separate processor** (`--link host`) both cameras run `sighting.s`, and the processor
  runs any algorithm, in floating point.

Camera 1 reads the bytes with `IN`, which the instruction set has for this ([isa.md](isa.md#in)).
A number that is the same in all NPs travels once; a byte of each NP would be 80 bytes.

The array needs ratios that are the same power of two, and positions within ±8 m, the range of
Q12 words. The program sends only `valid`; `npchip.host.rig` adds the marks for objects behind a
camera, at a border or with rays apart. For `border` it also runs
[`asm/tracking.s`](../asm/tracking.s), which finds the same box and sends its sides; no cycle of
that counts, as only the host wants to know.

## Which link limits the frame rate?

T1 and T2 are the cycles of the two programs, A those of camera 1 before its `IN`, L those of
the link, and H is the `host_latency`:

| link | L for n bytes | latency | period, pipelined |
| --- | --- | --- | --- |
| serial | n · serial_byte · serial_bit | max(A, T2 + L) + T1 - A | max(T1, T2, L) |
| parallel | ⌈8n / parallel_bits⌉ · parallel_word | the same | the same |
| processor | serial, two lines | max(T1, T2) + L + H | max(T1, T2, L, H) |

Widths and cycles come from the [machine file](machine.md#the-link); they are decisions, as no
such link was ever built. *Pipelined* assumes that the cameras expose the next frame while the link
still carries the last one; camera 1 then keeps its own position of the object for a frame, in two
bytes of memory. Without pipelining a frame takes the latency. The table shows the worst frame of
the example, with frames per second at {mhz} MHz (illustrative) and without exposure time.

{links}

**None of the links limits it, on either machine: {limit} does.** Camera 2 sends {sent} bytes a
frame. Even one bit at a time these take only {share_default:.0f} % of the time of camera 1
(`default`) or {share_conservative:.0f} % (`conservative`). A serial link becomes the slowest
part at more than {even_default} and {even_conservative} cycles a bit: below {rate_default:.0f}
and {rate_conservative:.0f} kbit/s at {mhz} MHz. A separate processor takes the lookup from
camera 1, which shortens the period by {gain_default:.0f} % and {gain_conservative:.0f} %. Its
latency is {latency}, so it depends on timing that nobody published.

The thesis's worry is justified if whole pictures travel, not if only the results do:

{payloads}

So track on the array first. The amount of data decides, not the link.

## How exact

RMS of the distance from the true middle of the ball, over the {whole} frames in which no edge
cuts it off:

{errors}

The bound is the error that remains if each camera knows in which pixel the middle of the ball lies,
and nothing else is wrong. The array does better because the middle of a box comes in half pixels.

## Follow what moves, and predict it

In real video an object is rarely brighter than all else. With `--follow --link host` both cameras
run [`asm/follow.s`](../asm/follow.s), which follows what moves ([tracking.md](tracking.md)), and a
processor locates it. `--predict N` adds where it will be N frames later, on the straight line
through its positions of the last {window} frames; in JSON as `predicted`:

```console
$ npchip fuse ball.1 ball.2 --rig chip --predict 4
{predicted}
...
```

Begin with frames without the object: `follow.s` takes what it sees first for the background. Here
are the same ball and {blank} frames without it before; the error in frames in which both programs
have all that they need, RMS in metres:

{following}

A centroid of many pixels is finer than the middle of a box. The prediction is of frames to come,
against where the ball then truly is; *stays* takes the newest position for it. The ball bounces,
which no straight line foresees.

## Cameras that are turned

A rig file says where cameras stand; that they look level and straight along an axis is more than
anybody can mount. `turned: [right, up, clockwise]` of a camera, in degrees, says how far it does
not. A processor straightens its pixels first, so every algorithm works (`--link host`; the array
takes cameras that stand straight, NP522). `npchip scene --rig` draws what such cameras see.

`--calibrate` finds the angles from known points. POINTS.csv has the columns x, y, z in metres and
row1, col1, row2, col2 in pixels, empty where a camera does not see a point; other columns are
ignored, so a table of `--csv` with the true places put in will do:

```console
$ npchip fuse --calibrate examples/rigs/points.csv --rig examples/rigs/chip.yaml
{calibrated}
...
```

`-o RIG.yaml` writes the rig so turned. The cameras that saw these 12 points are turned by 1°,
-0.5°, 0.5° and by -1°, 0.5°, -0.5°.

*before* and *after* are the distances in pixels (RMS) between where the points are seen and where
the rig expects them; rounding to pixels alone makes .41. `--json` prints `schema` 1, `points`,
`before`, `after` and `rig`.

{paths} random paths on `chip.yaml`, camera 2 turned about its vertical (*pan*), its horizontal
(*tilt*) or its view (*roll*); both cameras are calibrated from known points in whole pixels. RMS in
metres, {sets} sets:

{turned}

**{verdict}**

## CSV, JSON and marks

`--csv FILE` writes one line for each frame, with all digits, and the latency with each link; fields
without a value are empty. `--json` prints `schema` 1, `rig`, `machine`, `algorithm`, `link` and
`clock_hz`; `links`, for each the `bytes` and the worst `parts`, `latency` and `period` in
cycles, and the part that is the `limit`; and `frames`, each with `index`, `camera1` and
`camera2` ([row, column] or null), `position` ([x, y, z] or null), `mark` and `cycles` (the
latency by link).

Marks are `ok`, `border` (the object's box touches an edge of a frame: it may be cut off), `apart`,
`unseen`, `unseen by 1`, `unseen by 2`, `parallel`, `behind` and `overflow`, explained in
[fusion.md](fusion.md#marks).

`apart` says that the rays miss each other: both cameras see a height, and no change of the rows and
columns by half a pixel makes them equal. The position is that of the algorithm, but something is
wrong, and the run says so on standard error: the clips may be exchanged or not exposed together, or
the rig file belongs to other cameras. Exchanged clips do not show in every frame, as an object near
the middle plane of both cameras fits either way.

From Python:

```python
from npchip.frames import open_frames
from npchip.host.rig import watch
from npchip.host.vision.fusion import load_rig

left, right = (open_frames(f"examples/rigs/ball.{{n}}.gif", 64, 80) for n in (1, 2))
seen = watch(load_rig("examples/rigs/chip.yaml"), left, right, algorithm="extra-step")
print(seen.positions.points[1:4], seen.timings["serial"].limit)
```

## Mistakes

| code | meaning |
| --- | --- |
| NP520 | clips of different length |
| NP521 | npchip was installed without its programs |
| NP522 | what the array cannot compute: another algorithm, ratios, positions beyond ±8 m |
| NP523 | cameras of another size than the array |
| NP524 | a clip or `--rig` is missing |
| NP525 | a `--plot` file that is neither .png nor .svg |
| NP526 | `--follow` with another link than `host`, or with `--dark` |
| NP527 | a file of known points that cannot be read |
| NP528 | a camera that cannot be calibrated: too few points, or too close together |
"""


@cache
def seen(machine: str, algorithm: str = "improved-2n") -> Observation:
    """Run the example's two clips through the rig."""
    left, right = (open_frames(RIGS / f"ball.{n}.gif", 64, 80) for n in (1, 2))
    return watch(RIG, left, right, machine=machine, algorithm=algorithm)


def links() -> str:
    """Cycles by machine and link."""
    rows = []
    for machine in MACHINES:
        for name, timing in seen(machine).timings.items():
            period = int(timing.period.max())
            rows.append(
                [
                    f"`{machine}`",
                    "processor" if name == "host" else name,
                    *(f"{int(timing.parts[part].max()):,}" for part in ("camera 1", "camera 2")),
                    f"{int(timing.sent.max())}",
                    f"{int(timing.parts['link'].max()):,}",
                    f"{int(timing.latency.max()):,}",
                    f"{period:,}",
                    f"{ILLUSTRATIVE_CLOCK_HZ / period:,.0f}",
                ]
            )
    head = ["machine", "link", "T1", "T2", "bytes", "L", "latency", "period", "frames/s"]
    return table(head, rows, 7)


def payloads() -> str:
    """Tabulate what limits the frame rate if more bytes travel."""
    rows = []
    for what, size in (("a byte of each NP", 80), ("a picture", PICTURE)):
        for machine in MACHINES:
            chosen = load_machine(machine)
            chip = int(seen(machine).timings["serial"].parts["camera 1"].max())
            if size == PICTURE:
                chip = int(run("imaging", machine).column.result.frame_cycles.max())
            for kind in ("serial", "parallel"):
                carried = int(transfer_cycles(chosen.link, kind, size))
                period = max(chip, carried)
                rows.append(
                    [
                        f"{what}, {size:,} bytes",
                        f"`{machine}`",
                        kind,
                        f"{chip:,}",
                        f"{carried:,}",
                        f"{ILLUSTRATIVE_CLOCK_HZ / period:,.0f}",
                        "the link" if carried > chip else "the camera",
                    ]
                )
    head = ["sent in a frame", "machine", "link", "camera", "L", "frames/s", "limit"]
    return table(head, rows)


def errors() -> tuple[int, str]:
    """Frames in which the whole ball is seen, and the error of each way to its place."""
    scene = read_space_scene(RIGS / "ball.yaml")
    truth, whole = scene.positions(), np.ones(scene.frames, bool)
    for view in render_pair(scene, RIG):
        low, high = view.centers - view.radii[:, None], view.centers + view.radii[:, None]
        whole &= (low > -0.5).all(axis=1) & (high < (63.5, 79.5)).all(axis=1)

    def rms(points: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
        away = (points - truth)[whole]
        return f"{np.sqrt((away**2).sum(axis=1).mean()):.4f}".lstrip("0")

    found = seen("default")
    pixels = locate(RIG, RIG.camera1.observe(truth), RIG.camera2.observe(truth), "vector")
    middles = (found.seen1, found.seen2)
    rows = [
        ["bound: true middle, rounded to a pixel, vector", rms(pixels.points)],
        ["`improved-2n` on the array", rms(found.positions.points)],
        ["`extra-step` on the array", rms(seen("default", "extra-step").positions.points)],
        ["vector on a processor", rms(locate(RIG, *middles, "vector").points)],
        ["reprojection on a processor", rms(locate(RIG, *middles, "reprojection").points)],
    ]
    return int(whole.sum()), table(["", "RMS, m"], rows, 1)


def document() -> str:
    """The page."""
    facts: dict[str, object] = {}
    limits, latencies = set(), []
    for machine in MACHINES:
        timings, link = seen(machine).timings, load_machine(machine).link
        serial, host = timings["serial"], timings["host"]
        period, sent = int(serial.period.max()), int(serial.sent.max())
        limits |= {serial.limit, timings["parallel"].limit}
        even = period / (8 * sent) * 8 / link.serial_byte
        facts[f"share_{machine}"] = 100 * int(serial.parts["link"].max()) / period
        facts[f"even_{machine}"] = int(even)
        facts[f"rate_{machine}"] = ILLUSTRATIVE_CLOCK_HZ / even / 1000
        facts[f"gain_{machine}"] = 100 * (1 - int(host.period.max()) / period)
        better = int(host.latency.max()) < int(serial.latency.max())
        latencies.append(f"{'shorter' if better else 'longer'} on `{machine}`")
        facts["sent"] = sent
    assert limits == {"camera 1"}, limits
    whole, errors_table = errors()
    clock = Clock(ILLUSTRATIVE_CLOCK_HZ, stated=False)
    lines = plain_text(seen("default"), clock).splitlines()
    summary = next(n for n, line in enumerate(lines) if line.startswith("#"))
    return TEXT.format(
        first="\n".join([*lines[:4], "...", *lines[summary : summary + 2]]),
        words=len(run("fusion_lut").program.words),
        links=links(),
        limit=limits.pop(),
        latency=" and ".join(latencies),
        payloads=payloads(),
        whole=whole,
        errors=errors_table,
        mhz=ILLUSTRATIVE_CLOCK_HZ // 10**6,
        window=WINDOW,
        blank=BLANK,
        following=following(),
        predicted=shown("ball.1", "ball.2", "--rig", "chip", "--predict", "4"),
        calibrated=shown("--calibrate", str(RIGS / "points.csv"), "--rig", str(RIGS / "chip.yaml")),
        paths=PATHS,
        sets=swept("calibration")["seed"].nunique(),
        turned=turned_cameras(),
        verdict=calibration_verdict(),
        **facts,
    )


if __name__ == "__main__":
    write_page("rig.md", document)
    draw(RIG, seen("default", "extra-step").positions, ROOT / "docs" / "figures" / "rig.svg")
