"""The input instruction: what a partner sent, in both engines, by frame and by turn."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, RunResult, assemble_text
from npchip.base.errors import InputError
from npchip.engines.base import Partner, Request
from tests.support.chips import clip_of, machine_of
from tests.support.lockstep import result_difference, state, state_difference

SOURCE = """
.output total, 0, plane
.output early, 1, scalar
frame:  EXPOSE
        MOV     r5, #9
        OUT     1, r5
        IN      r1, 3
        MOV     r4, #5
.wait:  SUB     r4, #1
        JANY    NE, .wait
        IN      r2, 3
        IN      r3, 7
        ADD     r1, r2
        ADD     r1, r3
        COL     r0
        CMP     r0, #1
        WHERE   EQ
          IN    r1, 7
        END
        OUT     0, r1
        JMP     frame
"""
MACHINE = machine_of()
ROWS, COLUMNS = np.indices(MACHINE.geometry).astype(np.uint8)


def sent(request: Request) -> NDArray[np.uint8]:
    """Bytes that differ by NP, port, frame and turn."""
    base = 100 * request.frame + 10 * request.port + 3 * request.index
    return (ROWS * np.uint8(16) + COLUMNS + np.uint8(base % 256)).astype(np.uint8)


def run(source: str, partner: Partner | None, frames: int = 4) -> tuple[RunResult, Chip]:
    """Run a source on both engines, with equal results and states."""
    program = assemble_text(source, "test.s", MACHINE)
    clip = clip_of(frames, MACHINE)
    chips = [Chip(program, MACHINE, "reference"), Chip(program, MACHINE, "wasm")]
    results = []
    for chip in chips:
        chip.connect(partner)
        results.append(chip.run(clip))
    assert not result_difference(*results)
    assert not state_difference(*map(state, chips))
    return results[0], chips[1]


def test_a_byte_for_every_np_by_frame_and_turn() -> None:
    result, _ = run(SOURCE, sent)
    assert result.outputs["early"].tolist() == [9] * 4
    for frame in range(4):
        bytes_of = [sent(Request(port, frame, n, 0)) for port, n in ((3, 0), (3, 1), (7, 0))]
        expected = sum(bytes_of[1:], bytes_of[0])
        masked = sent(Request(7, frame, 1, 0))
        expected[:, 1] = masked[:, 1]
        np.testing.assert_array_equal(result.outputs["total"][frame], expected)


def test_the_partner_is_told_when_it_is_asked() -> None:
    asked: list[Request] = []

    def partner(request: Request) -> NDArray[np.uint8]:
        asked.append(request)
        return sent(request)

    program = assemble_text(SOURCE, "test.s", MACHINE)
    chip = Chip(program, MACHINE)
    chip.connect(partner)
    chip.run(clip_of(2, MACHINE))
    # EXPOSE, MOV, OUT; then MOV and five times two instructions between the first two.
    at = 2 + MACHINE.cycles("output")
    expected = [Request(3, 0, 0, at), Request(3, 0, 1, at + 12), Request(7, 0, 0, at + 13)]
    expected += [Request(7, 0, 1, at + 19)]
    assert asked[:4] == expected
    assert asked[4:] == [Request(r.port, 1, r.index, r.cycle) for r in expected]


def test_nothing_more_sent_is_a_trap() -> None:
    def once(request: Request) -> NDArray[np.uint8] | None:
        return sent(request) if request.index == 0 else None

    result, chip = run(SOURCE, once)
    assert result.error is not None
    assert (result.error.code, result.error.line) == ("NP306", 11)
    assert "more than 1 bytes in this frame to port 3" in result.error.message
    assert chip.frames_taken == 1


@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_a_snapshot_knows_what_was_received(engine: str) -> None:
    program = assemble_text("IN r1, 0\nIN r2, 0\nIN r3, 0\nHALT", "test.s", MACHINE)
    chip = Chip(program, MACHINE, engine)  # type: ignore[arg-type] # one of its names
    chip.connect(sent)
    chip.step()
    before = chip.snapshot()
    for _ in range(2):
        chip.run()
        assert [chip.registers[n, 0, 0] for n in (1, 2, 3)] == [156, 159, 162]  # frame -1
        chip.restore(before)
    chip.reset()
    chip.run()
    assert chip.registers[1, 0, 0] == 156  # the wiring stays
    chip.reset()
    chip.connect(None)
    result = chip.run()
    assert result.error is not None
    assert result.error.code == "NP306"


@pytest.mark.parametrize("engine", ["reference", "wasm"])
@pytest.mark.parametrize(
    "answer", [np.zeros((8, 10)), np.zeros((8, 8), np.uint8), np.zeros(80, np.uint8)]
)
def test_what_a_partner_gives_is_checked(engine: str, answer: NDArray[np.uint8]) -> None:
    program = assemble_text(SOURCE, "test.s", MACHINE)
    chip = Chip(program, MACHINE, engine)  # type: ignore[arg-type] # one of its names
    chip.connect(lambda _: answer)
    with pytest.raises(InputError, match="from the partner: expected uint8") as caught:
        chip.run(clip_of(2, MACHINE))
    assert caught.value.code == "NP105"
    assert program.source[chip.pc].line == 7


@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_what_a_partner_raises_ends_the_run_before_the_input(engine: str) -> None:
    class BrokenLinkError(Exception):
        pass

    def breaks(request: Request) -> NDArray[np.uint8]:
        if request.frame == 1 and request.index == 1:
            raise BrokenLinkError
        return sent(request)

    chip = Chip(assemble_text(SOURCE, "test.s", MACHINE), MACHINE, engine)  # type: ignore[arg-type]
    chip.connect(breaks)
    with pytest.raises(BrokenLinkError):
        chip.run(clip_of(4, MACHINE))
    assert chip.frames_taken == 2
    assert chip.program.source[chip.pc].text.strip().startswith("IN      r2, 3")
    chip.connect(sent)
    rest = chip.run(clip_of(2, MACHINE))  # it goes on where it was
    assert rest.status == "frames-exhausted"


def test_programs_with_inputs_are_compiled() -> None:
    program = assemble_text(SOURCE, "test.s", MACHINE)
    chip = Chip(program, MACHINE)
    chip.connect(sent)
    result = chip.run(clip_of(100, MACHINE))
    assert (result.engine, chip.notice) == ("wasm", "")
    assert len(chip._engine._sessions) == 1  # type: ignore[attr-defined]  # noqa: SLF001
