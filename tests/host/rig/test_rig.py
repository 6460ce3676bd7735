"""Two chips as one camera system: positions, marks, cycles of the links."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip import Chip, assemble, load_machine
from npchip.base.errors import InputError
from npchip.engines.base import Request
from npchip.frames import open_frames
from npchip.host.rig import transfer_cycles, watch
from npchip.host.rig.links import camera_to_camera, with_processor
from npchip.host.scenes.stereo import read_space_scene, render_pair
from npchip.host.vision.fusion import CHIP, Status, apart, load_rig, locate
from npchip.machine import Link
from npchip.run.outputs import output_of
from npchip.run.partner import sent_by

ROOT = Path(__file__).parents[3]
RIGS = ROOT / "examples" / "rigs"
RIG = load_rig(RIGS / "chip.yaml")
SCENE = read_space_scene(RIGS / "ball.yaml")
Bytes = NDArray[np.uint8]


def clips(frames: int = 40) -> tuple[Bytes, Bytes]:
    one, two = (view.clip[:frames] for view in render_pair(SCENE, RIG))
    return one, two


def whole() -> NDArray[np.bool_]:
    """Frames of the example in which no edge of a frame cuts the ball off."""
    views, inside = render_pair(SCENE, RIG), np.ones(SCENE.frames, bool)
    for view in views:
        edges = [view.centers - view.radii[:, None], view.centers + view.radii[:, None] - (63, 79)]
        inside &= (edges[0] > -0.5).all(axis=1) & (edges[1] < 0.5).all(axis=1)
    return inside


def rms(points: NDArray[np.float64]) -> float:
    """Root of the mean squared distance from where the ball was, over the frames of `whole`."""
    error = (points - SCENE.positions())[whole()]
    return float(np.sqrt((error**2).sum(axis=1).mean()))


# ---- from clips to positions


@pytest.mark.parametrize("algorithm", ["improved-2n", "extra-step"])
def test_from_two_clips_to_a_path(algorithm: str) -> None:
    seen = watch(RIG, *clips(), algorithm=algorithm)
    host = locate(RIG, seen.seen1, seen.seen2, algorithm, CHIP)
    np.testing.assert_array_equal(seen.positions.raw, host.raw)
    np.testing.assert_array_equal(seen.positions.points, host.points)
    expected = np.where(cut_off() & host.valid, Status.BORDER, host.status)
    np.testing.assert_array_equal(seen.positions.status, expected)
    assert seen.positions.status[0] == Status.UNSEEN
    assert seen.positions.valid[1:].all()
    # What is lost where each camera knows the pixel in which the ball's middle lies.
    truth = SCENE.positions()
    pixels = locate(RIG, RIG.camera1.observe(truth), RIG.camera2.observe(truth), "vector")
    bound = rms(pixels.points)
    assert 30 < whole().sum() < 39
    assert 0.018 < bound < 0.022
    if algorithm == "extra-step":
        assert rms(seen.positions.points) < 0.75 * bound  # middles of boxes come in half pixels
    else:
        assert rms(seen.positions.points) < 1.1 * bound


def cut_off() -> NDArray[np.bool_]:
    """Frames in which a bright pixel lies at an edge of a frame."""
    edges = [clip >= 128 for clip in clips()]
    sides = [(c[:, [0, -1]].any(axis=(1, 2)), c[:, :, [0, -1]].any(axis=(1, 2))) for c in edges]
    return np.asarray(np.any(sides, axis=(0, 1)))


@pytest.mark.long
def test_an_object_that_touches_an_edge_is_marked() -> None:
    """Fails before: only a middle in the outermost row or column was."""
    one, two = np.zeros((2, 5, 64, 80), np.uint8)
    one[:, 20:29, 30:39] = two[:, 20:29, 40:49] = 200
    one[1:, 20:29, 30:39] = 0
    one[1, 0:9, 30:39] = one[2, 55:64, 30:39] = one[3, 20:29, 0:9] = one[4, 20:29, 71:80] = 200
    for link in ("serial", "host"):
        seen = watch(RIG, one, two, link=link, engine="reference")
        assert seen.positions.status.tolist() == [Status.OK] + 4 * [Status.BORDER]
        assert seen.positions.valid.all()


def test_rays_that_miss_each_other_are_marked() -> None:
    """Fails before: with exchanged clips 38 of 39 positions were ok."""
    one, two = clips()
    assert not (watch(RIG, one, two).positions.status == Status.APART).any()
    seen = watch(RIG, two, one)
    assert (seen.positions.status == Status.APART).sum() > 15
    assert seen.positions.valid.sum() == 39


@given(st.integers(0, 2**32 - 1))
def test_whole_pixels_of_a_point_are_never_apart(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.uniform((0, 0.5, -1), (4, 3, 1), (50, 3))
    one, two = RIG.camera1.observe(points), RIG.camera2.observe(points)
    assert not apart(RIG, one, two).any()
    high = two + np.array([6, 0])
    meet = np.isfinite(locate(RIG, one, two).points).all(axis=1)
    assert apart(RIG, one, high)[meet].mean() > 0.9 or not meet.any()


def test_the_clips_of_the_example_are_those_of_its_scene() -> None:
    for number, clip in enumerate(clips(), 1):
        source = open_frames(RIGS / f"ball.{number}.gif", 64, 80)
        np.testing.assert_array_equal(np.stack(list(source)), clip)


def test_middles_are_those_of_the_pixels_above_the_threshold() -> None:
    seen = watch(RIG, *clips(6), link="host", threshold=77)
    for clip, found in zip(clips(6), (seen.seen1, seen.seen2), strict=True):
        for frame, (row, col) in zip(clip, found, strict=True):
            rows, cols = np.nonzero(frame >= 77)
            if rows.size:
                assert (2 * row, 2 * col) == (rows.min() + rows.max(), cols.min() + cols.max())
            else:
                assert np.isnan([row, col]).all()


@pytest.mark.long
def test_a_dark_object_is_seen_as_a_bright_one() -> None:
    one, two = clips(5)
    bright = watch(RIG, one, two, engine="reference")
    dark = watch(RIG, 255 - one, 255 - two, dark=True, engine="reference")  # 255 - 127 = 128
    np.testing.assert_array_equal(bright.positions.raw, dark.positions.raw)


@pytest.mark.long
def test_engines_agree_on_positions_and_cycles() -> None:
    one, two = clips(5)
    machine = load_machine("conservative")
    a, b = (
        watch(RIG, one, two, machine=machine, engine=engine) for engine in ("reference", "wasm")
    )
    np.testing.assert_array_equal(a.positions.raw, b.positions.raw)
    assert set(a.timings) == {"serial", "parallel", "host"}
    for name, timing in a.timings.items():
        np.testing.assert_array_equal(timing.latency, b.timings[name].latency)
        np.testing.assert_array_equal(timing.period, b.timings[name].period)


def test_a_processor_computes_every_algorithm() -> None:
    one, two = clips(4)
    for algorithm in ("vector", "reprojection"):
        seen = watch(RIG, one, two, algorithm=algorithm, link="host")
        expected = locate(RIG, seen.seen1, seen.seen2, algorithm)
        np.testing.assert_array_equal(seen.positions.points, expected.points)
        assert list(seen.timings) == ["host"]


@pytest.mark.long
def test_what_the_array_does_not_say_is_marked() -> None:
    """Rays that meet behind a camera, or too far away for a word."""
    far = replace(
        RIG,
        camera1=replace(RIG.camera1, position=(7.9, 0, 0)),
        camera2=replace(RIG.camera2, position=(0, 7.9, 0)),
    )
    clip = np.zeros((2, 64, 80), np.uint8)
    clip[0, 20, 75], clip[1, 20, 40] = 255, 255
    seen = watch(far, clip, clip[:, :, ::-1], engine="reference")
    host = locate(far, seen.seen1, seen.seen2, "improved-2n", CHIP)
    assert seen.positions.status.tolist() == host.status.tolist()
    assert seen.positions.status[0] == Status.OVERFLOW
    back = replace(RIG, camera2=replace(RIG.camera2, looks="-x"))
    seen = watch(back, clip, clip, engine="reference")
    assert set(seen.positions.status.tolist()) == {Status.BEHIND}


def test_clips_of_different_length_are_refused() -> None:
    one, two = clips(5)
    for pair in ((one, two[:4]), (iter(one[:3]), iter(two))):
        with pytest.raises(InputError) as caught:
            watch(RIG, *pair)
        assert caught.value.code == "NP520"
    assert "camera 1 has 3 frames, that of camera 2 5" in caught.value.message


@pytest.mark.parametrize(
    ("values", "code"),
    [
        ({"algorithm": "vector"}, "NP522"),
        ({"algorithm": "none", "link": "host"}, "NP505"),
        ({"machine": replace(load_machine("default"), name="x", np_cols=9)}, "NP523"),
    ],
)
def test_what_a_rig_cannot_do_is_refused(values: dict[str, Any], code: str) -> None:
    with pytest.raises(InputError) as caught:
        watch(RIG, *clips(2), **values)
    assert caught.value.code == code


@pytest.mark.long
def test_the_two_are_different_chips() -> None:
    """Noise of both cameras is that of each alone, the seed of camera 2 being the next."""
    one, two = clips(4)
    default = load_machine("default")
    sensor = replace(default.sensor, noise_rms=32, seed=2**32 - 1)
    machine = replace(default, name="x", sensor=sensor)
    seen = watch(RIG, one, two, machine=machine, threshold=60)
    host = locate(RIG, seen.seen1, seen.seen2, "improved-2n", CHIP)
    np.testing.assert_array_equal(seen.positions.raw, host.raw)
    program = assemble(ROOT / "asm" / "sighting.s", defines={"THRESHOLD": 60})
    for clip, seed, found in ((one, 2**32 - 1, seen.seen1), (two, 0, seen.seen2)):
        chip = replace(machine, sensor=replace(sensor, seed=seed))
        alone = Chip(program, chip).run(clip).outputs
        where = np.stack([alone["twice_row"], alone["twice_col"]], -1) / 2
        np.testing.assert_array_equal(found, np.where(alone["seen"][:, None], where, np.nan))


def test_a_machine_may_be_very_slow() -> None:
    slow = replace(load_machine("default"), name="slow", default_cycles=1_000_000)
    seen = watch(RIG, *clips(2), machine=slow)
    assert seen.timings["serial"].latency.min() > 500_000_000


# ---- links

LINKS = st.builds(
    Link,
    serial_bit=st.integers(1, 100),
    serial_byte=st.integers(8, 16),
    parallel_bits=st.integers(1, 64),
    parallel_word=st.integers(1, 50),
    host_latency=st.integers(0, 3000),
)
CYCLES = st.integers(1, 5000)


def bit_by_bit(link: Link, kind: str, sent: int) -> int:
    """Cycles of a transfer, by counting what goes over the lines."""
    cycles = 0
    if kind == "serial":
        for _ in range(sent):
            for _ in range(link.serial_byte):
                cycles += link.serial_bit
        return cycles
    left = 8 * sent
    while left > 0:
        left -= link.parallel_bits
        cycles += link.parallel_word
    return cycles


@given(LINKS, st.integers(0, 300), st.sampled_from(["serial", "parallel"]))
def test_transfers(link: Link, sent: int, kind: str) -> None:
    assert transfer_cycles(link, kind, sent) == bit_by_bit(link, kind, sent)


def simulated(parts: list[int], period: int, frames: int = 60) -> list[int]:
    """When the last of some parts, one after the other, is done with each frame.

    A frame comes every `period` cycles; a part takes the next when it is free.
    """
    free = [0] * len(parts)
    done = []
    for k in range(frames):
        at = k * period
        for n, cycles in enumerate(parts):
            at = free[n] = max(at, free[n]) + cycles
        done.append(at)
    return done


@settings(max_examples=60)
@given(
    LINKS,
    st.sampled_from(["serial", "parallel"]),
    st.tuples(CYCLES, CYCLES, CYCLES, st.integers(1, 90)),
)
def test_camera_to_camera(link: Link, kind: str, numbers: tuple[int, int, int, int]) -> None:
    asked, rest, second, sent = numbers
    one = np.array([asked + rest])
    timing = camera_to_camera(
        link, kind, np.array([sent]), asked=np.array([asked]), first=one, second=np.array([second])
    )
    carried = bit_by_bit(link, kind, sent)
    here = second + carried  # the bytes are there, and camera 1 has asked for them
    assert timing.latency[0] == max(here, asked) + rest
    period = int(timing.period[0])
    assert period == timing.parts[timing.limit][0]
    # With that period nothing piles up; with one cycle less something does.
    for parts in ([asked + rest], [second, carried]):
        done = simulated(parts, period)
        assert done[-1] - 59 * period == done[0]
    late = [simulated(parts, period - 1) for parts in ([asked + rest], [second, carried])]
    assert any(done[-1] - 59 * (period - 1) > done[0] for done in late)


@settings(max_examples=60)
@given(LINKS, CYCLES, CYCLES, st.integers(1, 90))
def test_with_a_processor(link: Link, first: int, second: int, sent: int) -> None:
    timing = with_processor(
        link, np.array([sent]), first=np.array([first]), second=np.array([second])
    )
    carried = bit_by_bit(link, "serial", sent)
    assert timing.latency[0] == max(first, second) + carried + link.host_latency
    period = int(timing.period[0])
    for camera in (first, second):
        done = simulated([camera, carried, link.host_latency], period)
        assert done[-1] - 59 * period == done[0]
    assert period == max(first, second, carried, link.host_latency)


@pytest.mark.long
def test_cycles_are_those_of_the_chips() -> None:
    """Two conversions and 64 pixels cost the same on both; the link comes on top."""
    one, two = clips(3)
    seen = watch(RIG, one, two)
    program = assemble(ROOT / "asm" / "sighting.s")
    second = Chip(program).run(two)
    serial = seen.timings["serial"]
    np.testing.assert_array_equal(serial.parts["camera 2"], second.frame_cycles)
    np.testing.assert_array_equal(serial.sent, [2, 2, 2])  # seen and twice_col
    np.testing.assert_array_equal(serial.parts["link"], [32, 32, 32])  # 2 cycles a bit
    np.testing.assert_array_equal(seen.timings["host"].sent, [3, 3, 3])
    slow = replace(load_machine("default"), link=Link(500, 8, 8, 2, 100))
    late = watch(RIG, one, two, machine=slow).timings["serial"]
    np.testing.assert_array_equal(late.latency - serial.latency, [7968] * 3)  # 16 bits
    assert (late.limit, serial.limit) == ("link", "camera 1")


# ---- what a partner has sent

SENDER = """
.output scalar, 0, scalar
.output long,   1, scalar16
.output list,   2, list
.output plane,  3, plane
.output image,  4, picture
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     r0, #0
.pixel: LD      r1, [r0]
        OUT     4, r1
        ADD     r0, #1
        CMP     r0, #64
        JANY    LO, .pixel
        OUT     3, r1
        OUT     9, r1
        MOV     r2, #77
        OUT     0, r2
        OUT     1, r2
        OUT     2, r2
        MOV     r2, #3
        OUT     1, r2
        OUT     2, r2
        JMP     frame
"""


def test_every_kind_of_output_reaches_the_partner(tmp_path: Path) -> None:
    source = tmp_path / "sender.s"
    source.write_text(SENDER)
    program, machine = assemble(source), load_machine("default")
    clip = clips(3)[0]
    partner = sent_by(program, Chip(program).run(clip), machine.geometry)

    def sent(port: int, index: int = 0, frame: int = 1) -> Any:
        return partner(Request(port, frame, index, 0))

    for port, values in ((0, [77]), (1, [77, 3]), (2, [77, 3])):
        for index, value in enumerate(values):
            np.testing.assert_array_equal(sent(port, index), np.full((8, 10), value))
        assert sent(port, len(values)) is None
    for index in range(64):
        y, x = divmod(index, 8)
        np.testing.assert_array_equal(sent(4, index), clip[1, y::8, x::8])
    assert sent(4, 64) is None
    for port in (3, 9):
        np.testing.assert_array_equal(sent(port), clip[1, 7::8, 7::8])
    assert [output_of(program, port).kind for port in (1, 9)] == ["scalar16", "plane"]
    assert sent(5) is None  # nothing sent
    assert sent(0, frame=-1) is None
    assert sent(0, frame=3) is None


@pytest.mark.parametrize("value", [".inf", "-.inf", ".nan", "1.5", "0"])
@pytest.mark.parametrize("key", ["rows", "cols"])
def test_a_size_that_is_no_whole_number_is_out_of_range(
    key: str, value: str, tmp_path: Path
) -> None:
    """An infinite one was an internal error."""
    file = tmp_path / "rig.yaml"
    text = (RIGS / "chip.yaml").read_text(encoding="utf-8")
    file.write_text(text.replace("looks: +y", f"looks: +y, {key}: {value}"), encoding="utf-8")
    with pytest.raises(InputError, match=rf"camera1\.{key}: expected a whole number from 1"):
        load_rig(file)
