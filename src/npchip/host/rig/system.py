"""Run of both cameras on their clips, and positions from their results."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.assembler import assemble
from npchip.base.errors import InputError
from npchip.engines.base import Request
from npchip.frames import FrameSource
from npchip.frames.feed import Frames
from npchip.host.rig.array import ENTRIES, check_sizes, definitions, entries, program_path
from npchip.host.rig.links import Timing, camera_to_camera, with_processor
from npchip.host.vision.fusion import (
    CHIP,
    Positions,
    Rig,
    Status,
    apart,
    build_table,
    locate,
    predict,
)
from npchip.host.vision.fusion.locate import finished, seen_status
from npchip.machine import Machine, load_machine
from npchip.program.model import Program
from npchip.run.chip import Chip
from npchip.run.outputs import KINDS, output_of
from npchip.run.partner import sent_by
from npchip.run.result import FrameRecord, RunResult

COMPILE_FROM = 20
"""Fewest frames for which compiling the programs saves time."""

WINDOW = 4
"""Newest positions that a prediction in space uses."""

SLACK_OF_CENTROIDS = 2.0
"""Error of the centroid of what moves, in pixels (docs/tracking.md)."""

_NO_LIMIT = 10**15
"""Limit of the cycles of a frame that no program reaches, however slow the machine."""

OnFrame = Callable[[FrameRecord], None]
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Observation:
    """Observation of an object by a rig in T frames.

    Attributes:
        algorithm: a name of `npchip.host.vision.fusion.ALGORITHMS`.
        link: a name of `npchip.host.rig.LINKS`; with ``"host"`` a processor computed the positions.
        machine: machine of both arrays.
        seen1, seen2: float64, shape (T, 2): (row, column) of the middle of the object's box, in
            steps of half a pixel, or of what it follows, in 256ths; NaN where a camera sees no
            object.
        positions: positions of shape (T,), with `raw` if the array computed them. Besides what
            `locate` marks, `BORDER` marks boxes that touch the edge of a frame, and `APART` rays
            that miss each other.
        timings: cycles of each frame, by link; only ``"host"`` if a processor computed the
            positions.
        follows: whether the cameras follow what moves.
        ahead: frames by which `predicted` looks ahead; 0 without a prediction.
        predicted: float64, shape (T, 3): row k is where the object will be in frame k + `ahead`, on
            the straight line through its positions in the last `WINDOW` frames; NaN where there is
            but one.
    """

    algorithm: str
    link: str
    machine: Machine
    seen1: Floats
    seen2: Floats
    positions: Positions
    timings: dict[str, Timing]
    follows: bool = False
    ahead: int = 0
    predicted: Floats | None = None


def watch(
    rig: Rig,
    clip1: Frames,
    clip2: Frames,
    *,
    algorithm: str = "improved-2n",
    link: Literal["serial", "parallel", "host"] = "serial",
    machine: str | Path | Machine = "default",
    engine: Literal["auto", "wasm", "reference"] = "auto",
    threshold: int | None = None,
    dark: bool = False,
    follow: bool = False,
    ahead: int = 0,
    on_frame: OnFrame | None = None,
) -> Observation:
    """Run two cameras on their clips; the programs are `asm/sighting.s` and `asm/fusion_lut.s`.

    Cameras that follow what moves run `asm/follow.s` instead, and a processor locates it.

    Args:
        rig: the cameras; both are arrays of the machine.
        clip1: frames of camera 1, as for `npchip.Chip.run`.
        clip2: frames of camera 2, of the same number.
        algorithm: name of the algorithm. Camera 1 can compute those of `ON_ARRAY`; a separate
            processor can compute all, in floating point.
        link: link between the cameras.
        machine: machine of both arrays, with the links. Camera 2 is another chip, whose sensor has
            the next seed.
        engine: as for `npchip.Chip`; ``"auto"`` compiles for `COMPILE_FROM` frames or more.
        threshold: least brightness of the object's pixels, 1 to 255, by default 128; with `follow`
            the least change of a pixel, by default that of the program.
        dark: whether the object's pixels are those below the threshold instead.
        follow: whether to follow what moves, in real video; the link must be ``"host"``.
        ahead: frames by which to predict positions in space; 0 for no prediction.
        on_frame: called with every frame of the runs of each camera, and of a second one of
            camera 1 if it computes the positions.

    Returns:
        positions, marks and cycles of all frames.

    Raises:
        InputError: a clip, the machine or the rig cannot be used; NP520 clips of different
            length, NP522 and NP523 as `definitions` and `entries`, NP526 `follow` with another link
            or with `dark`, NP505 and NP506 as `npchip.host.vision.fusion.locate`.
    """
    if follow:
        _check_follow(link, dark)
    chosen = load_machine(machine)
    check_sizes(rig, chosen)
    clip1, clip2 = _held(clip1), _held(clip2)
    _check_lengths(_count(clip1), _count(clip2))
    on_array = link != "host"
    if on_array:
        definitions(rig, algorithm)
    else:
        locate(rig, np.zeros((0, 2)), np.zeros((0, 2)), algorithm)  # refuses what it cannot do
    if engine == "auto" and (_count(clip1) or COMPILE_FROM) < COMPILE_FROM:
        engine = "reference"
    constants = {} if threshold is None else {"THRESHOLD": threshold}
    if not follow:
        constants["DARK"] = int(dark)
    cameras = _Cameras(chosen, engine, constants, on_frame)
    other = replace(cameras, machine=_another(chosen))
    name = "follow" if follow else "sighting"
    program, second = other.sight(clip2, name)
    _, first = cameras.sight(clip1, name)
    _check_lengths(first.frames, second.frames)
    places = _centroids if follow else _middles
    seen1, seen2 = (places(result.outputs) for result in (first, second))
    sizes = [2 if output.kind == "scalar16" else 1 for output in program.outputs]
    sent = np.full(first.frames, sum(sizes), np.int64)
    timings: dict[str, Timing] = {}
    if on_array:
        asked, carried, raw = cameras.fuse(rig, algorithm, clip1, (program, second))
        for kind in ("serial", "parallel"):
            cycles = {"first": raw.frame_cycles, "second": second.frame_cycles}
            timings[kind] = camera_to_camera(chosen.link, kind, carried, asked=asked, **cycles)
        positions = _of_array(rig, raw, seen1, seen2)
    else:
        positions = locate(rig, seen1, seen2, algorithm)
    timings["host"] = with_processor(
        chosen.link, sent, first=first.frame_cycles, second=second.frame_cycles
    )
    cut_off = np.zeros(first.frames, bool)
    if not follow:  # which marks by the centroid alone
        cut_off = cameras.touches_edge(clip1) | other.touches_edge(clip2)
    missed = apart(rig, seen1, seen2, SLACK_OF_CENTROIDS if follow else 0.5)
    positions = _marked(positions, cut_off, missed)
    seen = Observation(algorithm, link, chosen, seen1, seen2, positions, timings, follow)
    if ahead:
        located = predict(positions.points, steps=ahead, window=WINDOW)
        seen = replace(seen, ahead=ahead, predicted=located)
    return seen


def _check_follow(link: str, dark: bool) -> None:
    if link != "host":
        raise InputError(
            "NP526",
            f"cameras that follow what moves send it to a processor, but the link is {link}",
            hint="take --link host",
        )
    if dark:
        raise InputError(
            "NP526",
            "cameras that follow what moves follow dark and bright objects alike",
            hint="leave out --dark",
        )


def _marked(
    positions: Positions, cut_off: NDArray[np.bool_], missed: NDArray[np.bool_]
) -> Positions:
    """Mark what the pixels of the middles alone do not tell."""
    status = positions.status.copy()
    status[(status == Status.OK) & cut_off] = Status.BORDER
    status[(status == Status.OK) & missed] = Status.APART
    return replace(positions, status=status)


def _another(machine: Machine) -> Machine:
    """Return another chip of the same make, with other offsets and noise of its pixels."""
    seed = (machine.sensor.seed + 1) % 2**32
    return replace(machine, sensor=replace(machine.sensor, seed=seed))


def _held(clip: Frames) -> FrameSource | NDArray[Any]:
    """Return frames that can be read more than once."""
    if isinstance(clip, FrameSource | np.ndarray):
        return clip
    return np.stack(list(clip))


def _count(clip: FrameSource | NDArray[Any]) -> int | None:
    if isinstance(clip, FrameSource):
        return clip.count
    return len(clip) if clip.ndim == 3 else 1


def _check_lengths(first: int | None, second: int | None) -> None:
    if None not in {first, second} and first != second:
        raise InputError(
            "NP520",
            f"the clip of camera 1 has {first} frames, that of camera 2 {second}",
            hint="both cameras must have been exposed together: cut the longer clip",
        )


@dataclass(frozen=True)
class _Cameras:
    """Settings of both arrays."""

    machine: Machine
    engine: Any
    constants: dict[str, int]
    on_frame: OnFrame | None

    def sight(self, clip: Frames, name: str) -> tuple[Program, RunResult]:
        """Run `sighting.s` or `follow.s`."""
        program = assemble(program_path(name), self.machine, self.constants)
        return program, self._run(Chip(program, self.machine, self.engine), clip, self.on_frame)

    def touches_edge(self, clip: Frames) -> NDArray[np.bool_]:
        """Return in which frames the object's box reaches an edge of the frame.

        `sighting.s` sends only the middle of the box. `tracking.s` finds the same box, and sends
        its sides: it runs for the marks alone, and none of its cycles count.
        """
        program = assemble(program_path("tracking"), self.machine, self.constants)
        chip = Chip(program, self.machine, self.engine)
        found = self._run(chip, clip, None).outputs
        first = (found["top"] == 0) | (found["left"] == 0)
        last = (found["bottom"] == self.machine.rows - 1) | (
            found["right"] == self.machine.cols - 1
        )
        return np.asarray((found["valid"] == 1) & (first | last))

    def fuse(
        self, rig: Rig, algorithm: str, clip: Frames, partner: tuple[Program, RunResult]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], RunResult]:
        """Run `fusion_lut.s` with a partner.

        Returns:
            cycles before the first input of each frame, bytes received in each frame, the result.
        """
        constants = self.constants | definitions(rig, algorithm)
        program = assemble(program_path("fusion_lut"), self.machine, constants)
        chip = Chip(program, self.machine, self.engine)
        chip.load_memory(ENTRIES, entries(rig, self.machine))
        other, result = partner
        answer = sent_by(other, result, self.machine.geometry)
        asked: dict[int, int] = {}
        received: Counter[int] = Counter()
        everywhere = self.machine.np_rows * self.machine.np_cols

        def receive(request: Request) -> NDArray[np.uint8] | None:
            asked.setdefault(request.frame, request.cycle)
            kind = KINDS[output_of(other, request.port).kind]
            received[request.frame] += everywhere if kind.form == "array" else 1
            return answer(request)

        chip.connect(receive)
        found = self._run(chip, clip, self.on_frame)
        frames = range(found.frames)
        cycles, sizes = (np.array([by[k] for k in frames], np.int64) for by in (asked, received))
        return cycles, sizes, found

    def _run(self, chip: Chip, clip: Frames, on_frame: OnFrame | None) -> RunResult:
        result = chip.run(clip, max_cycles=_NO_LIMIT, on_frame=on_frame)
        assert result.status == "frames-exhausted", result.error  # these programs do not fail
        return result


def _middles(outputs: dict[str, Any]) -> Floats:
    """Return (row, column) of the object, NaN where none was seen."""
    twice = np.stack([outputs["twice_row"], outputs["twice_col"]], -1)
    return np.where(outputs["seen"][:, None] == 1, twice / 2, np.nan)


def _centroids(outputs: dict[str, Any]) -> Floats:
    """Return (row, column) of what `follow.s` follows, NaN where it sees none."""
    places = [outputs[axis] + outputs[f"{axis}_sub"] / 256 for axis in ("row", "col")]
    return np.where(outputs["valid"][:, None] == 1, np.stack(places, -1), np.nan)


def _of_array(rig: Rig, result: RunResult, seen1: Floats, seen2: Floats) -> Positions:
    """Return the positions that the array has computed, with marks."""
    words = np.stack([result.outputs[name] for name in "xyz"], -1)
    raw = words.astype(np.int64) - (words >> 15 << 16)  # two's complement
    status = seen_status(rig, seen1, seen2)
    none = (status == Status.OK) & (result.outputs["valid"] == 0)
    first, second = (
        ((seen[none, 1] + 0.5) // rig.cell).astype(np.int64) for seen in (seen1, seen2)
    )
    why = build_table(rig).status[first, second]
    status[none] = np.where(why == Status.OK, Status.OVERFLOW, why)
    points, bits = raw / 2.0**CHIP.fraction_bits, (CHIP.word_bits, CHIP.product_bits)
    return finished(rig, points, status, (seen1, seen2), raw=raw, bits=bits)
