"""Links between two chips, bit by bit, and what a partner has sent."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, assemble, load_machine
from npchip.base.errors import InputError
from npchip.engines.base import Request
from npchip.host.rig import transfer_cycles, watch
from npchip.host.rig.links import camera_to_camera, with_processor
from npchip.host.vision.fusion import load_rig
from npchip.machine import Link
from npchip.run.outputs import output_of
from npchip.run.partner import sent_by
from tests.host.rig.ball import RIG, RIGS, clips

ROOT = Path(__file__).parents[3]


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
    """Return the time at which the last of some parts, one after the other, ends each frame.

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
