"""Outputs: what was sent, as the program names it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pytest

from npchip.program import OUTPUT_KINDS
from npchip.run.outputs import KINDS
from tests.support.chips import FILE, chip_of, clip_of, machine_of, places, plane

if TYPE_CHECKING:
    from npchip.program.model import OutputKind
    from npchip.run.result import FrameRecord, RunResult

SMALL = machine_of()
ROW, _ = places(SMALL)


def run_sends(kind: str, body: str, frames: int = 1) -> RunResult:
    """Run `body` once for each frame, with one output of a kind at port 2; r15 counts frames."""
    source = f".output it, 2, {kind}\nMOV r15, #255\nframe: EXPOSE\nADD r15, #1\n{body}\nJMP frame"
    return chip_of(source).run(clip_of(frames, SMALL))


def test_scalar_is_the_last_byte() -> None:
    result = run_sends("scalar", "OUT 2, r1\nADD r1, #7\nOUT 2, r1", 3)
    assert result.outputs["it"].tolist() == [7, 14, 21]
    assert result.outputs["it"].dtype == np.int32
    assert not np.ma.isMaskedArray(result.outputs["it"])
    assert result.value("it", 2) == 21


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list"])
def test_scalars_must_agree(kind: str) -> None:
    source = f"""
    .output it, 2, {kind}
        NOP
        EXPOSE
        ROW r0
        CMP r0, #0
        WHERE NE                ; the first row does not matter
          COL r1
          OUT 2, r1
          OUT 2, r1
        END
        NOP
        EXPOSE
    """
    chip = chip_of(source)
    result = chip.run(clip_of(2, SMALL))
    assert result.status == "failed"
    assert result.error is not None
    assert result.error.code == "NP310"
    assert (result.error.address, result.error.file) == (7 if kind == "scalar" else 6, FILE)
    assert result.error.line == (9 if kind == "scalar" else 8)
    assert result.error.processor == (1, 1)
    assert "NP(1,0) sent 0 and NP(1,1) sent 1" in result.error.message
    # The frame stays in the account, without its outputs.
    assert result.frame_cycles.tolist() == [7 + 2 * 3]
    assert (result.setup.cycles, result.cycles) == (1, chip.cycles)
    assert result.value("it", 0) is None
    assert not result.last_complete


@pytest.mark.parametrize(
    ("kind", "sends", "expected"), [("scalar", 1, 5), ("list", 2, [5, 5]), ("scalar16", 2, 0x0505)]
)
def test_only_active_processors_must_agree(kind: str, sends: int, expected: Any) -> None:
    """The 0 of those that did not send is no byte of theirs."""
    sending = "OUT 2, r1\n" * sends
    result = run_sends(kind, f"MOV r1, #5\nCOL r2\nCMP r2, #1\nWHERE HI\n{sending}END")
    assert result.status == "frames-exhausted"
    assert result.value("it", 0) == expected


@pytest.mark.parametrize("end", ["HALT", "RET", "JMP end", "EXPOSE"])
def test_outputs_that_cannot_be_read(end: str) -> None:
    """Judged where a frame is complete; one that was cut short may have sent half of them."""
    source = f".output it, 2, scalar16\nNOP\nEXPOSE\nOUT 2, r1\nend: {end}\nHALT"
    chip = chip_of(source)
    result = chip.run(clip_of(1, SMALL), max_cycles=20)
    assert result.error is None or result.error.code == {"RET": "NP302"}.get(end, "NP311")
    assert (result.status == "cycle-limit") == (end == "JMP end")
    assert result.frames == 1
    assert result.cycles == chip.cycles
    assert result.value("it", 0) is None
    assert not result.last_complete


def test_setup_that_cannot_be_read() -> None:
    chip = chip_of(".output it, 2, scalar16\nOUT 2, r1\nNOP\nEXPOSE\nHALT")
    result = chip.run(clip_of(1, SMALL))
    assert result.error is not None
    assert (result.error.code, result.error.address) == ("NP311", 0)
    assert (result.setup.cycles, result.setup.complete, result.frames) == (4, False, 0)
    assert result.setup.outputs == {"it": None}


def test_scalar_of_sixteen_bits() -> None:
    result = run_sends("scalar16", "MOV r1, #52\nOUT 2, r1\nMOV r1, #254\nOUT 2, r1", 2)
    assert result.outputs["it"].tolist() == [254 * 256 + 52] * 2
    for sends in (1, 3):
        result = run_sends("scalar16", "OUT 2, r1\n" * sends)
        assert result.error is not None
        assert result.error.code == "NP311"
        assert f"found {sends}" in result.error.message


def test_list_is_every_send() -> None:
    body = "CMP r15, #1\nJANY EQ, frame\nOUT 2, r15\nMOV r1, #9\nOUT 2, r1\nOUT 2, r1"
    result = run_sends("list", body, 3)
    assert result.outputs["it"] == [[0, 9, 9], None, [2, 9, 9]]
    assert result.value("it", 1) is None


def test_plane_is_the_last_send() -> None:
    body = "CMP r15, #1\nJANY EQ, frame\nOUT 2, r1\nROW r1\nADD r1, r15\nOUT 2, r1"
    result = run_sends("plane", body, 3)
    planes = result.outputs["it"]
    assert planes.shape == (3, 3, 4)
    assert plane(result.value("it", 0)) == ROW.tolist()
    assert plane(result.value("it", 2)) == (ROW + 2).tolist()
    assert result.value("it", 1) is None
    assert planes.mask[1].all()
    assert not planes.mask[0].any()


@pytest.mark.parametrize("sends", [63, 64, 65])
def test_picture_is_64_sends(sends: int) -> None:
    body = f"MOV r0, #0\n.more: OUT 2, r0\nADD r0, #1\nCMP r0, #{sends}\nJANY LO, .more"
    result = run_sends("picture", body)
    if sends == 64:
        assert result.status == "frames-exhausted"
        picture = result.outputs["it"][0]
        expected = [[8 * (y % 8) + x % 8 for x in range(32)] for y in range(24)]
        assert picture.tolist() == expected
    else:
        assert result.error is not None
        assert result.error.code == "NP311"
        assert f"found {sends}" in result.error.message


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list", "plane", "picture"])
def test_nothing_sent(kind: str) -> None:
    result = run_sends(kind, "NOP", 2)
    assert [result.value("it", k) for k in range(2)] == [None, None]
    assert result.setup.outputs == {"it": None}
    column = result.outputs["it"]
    assert len(column) == 2
    assert kind == "list" or column.mask.all()


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list", "plane", "picture"])
def test_sends_without_an_active_processor(kind: str) -> None:
    """None for scalars; zeros for planes and pictures."""
    sends = {"scalar16": 2, "picture": 64}.get(kind, 1)
    sending = "OUT 2, r1\n" * sends
    result = run_sends(kind, f"MOV r1, #5\nCMP r1, #5\nWHERE NE\n{sending}END")
    assert result.status == "frames-exhausted"
    value = result.value("it", 0)
    if kind in {"plane", "picture"}:
        assert not any(number for row in plane(value) for number in row)
    else:
        assert value is None


def test_ports_without_a_name() -> None:
    chip = chip_of(
        """
        .output named, 0, scalar
                OUT 9, r0
        frame:  EXPOSE
                ADD r0, #1
                OUT 0, r0
                COL r1
                CMP r1, r0
                WHERE LO
                  OUT 15, r1
                END
                CMP r0, #2
                JANY NE, frame
                OUT 3, r0
                JMP frame
        """
    )
    result = chip.run(clip_of(3, SMALL))
    assert set(result.outputs) == {"named", "port3", "port15"}
    assert result.setup.outputs["named"] is None
    assert plane(result.setup.outputs["port9"]) == [[0] * 4] * 3
    assert result.value("port3", 0) is None
    assert plane(result.value("port3", 1)) == [[2] * 4] * 3
    assert plane(result.value("port15", 2)) == [[0, 1, 2, 0]] * 3


@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_ports_without_a_name_stand_in_their_order(engine: Literal["reference", "wasm"]) -> None:
    """The one that is used first may be another, and frames come one by one or many at once."""
    source = """
    .output b, 2, scalar
    .output a, 1, scalar
            MOV r2, #128
    frame:  EXPOSE
            ADD r1, r2
            JANY LO, more
            OUT 5, r1
            JMP frame
    more:   OUT 3, r1
            OUT 1, r1
            OUT 5, r1
            JMP frame
    """
    records: list[FrameRecord] = []
    result = chip_of(source, engine=engine).run(clip_of(4, SMALL), on_frame=records.append)
    assert [*result.outputs] == ["b", "a", "port3", "port5"]
    assert [[*record.outputs] for record in records[:2]] == [
        ["b", "a", "port5"],
        ["b", "a", "port3", "port5"],
    ]


def test_a_name_that_another_port_has() -> None:
    source = ".output port3, 0, scalar\n EXPOSE\n COL r0\n OUT 3, r0\n OUT 0, r1\n EXPOSE"
    result = chip_of(source).run(clip_of(1, SMALL))
    assert (result.value("port3", 0), plane(result.value("port3_", 0))[0]) == (0, [0, 1, 2, 3])


def test_ports_stand_in_order_although_one_has_another_name() -> None:
    source = ".output port7, 0, scalar\n EXPOSE\n OUT 12, r0\n EXPOSE\n OUT 7, r0\n EXPOSE"
    result = chip_of(source).run(clip_of(2, SMALL))
    assert [*result.outputs] == ["port7", "port7_", "port12"]


def test_a_run_that_halts_completes_its_frame() -> None:
    result = chip_of(".output n, 0, scalar\nEXPOSE\nMOV r1, #8\nOUT 0, r1\nHALT").run(
        clip_of(3, SMALL)
    )
    assert (result.status, result.last_complete) == ("halted", True)
    assert result.outputs["n"].tolist() == [8]
    assert result.frame_cycles.tolist() == [6]


def test_every_kind_is_defined() -> None:
    assert tuple(KINDS) == OUTPUT_KINDS


@pytest.mark.parametrize("bad", [0, 1, 70, 89])
@pytest.mark.parametrize("kind", ["scalar16", "picture", "list"])
def test_the_frame_to_blame_is_found_in_a_batch(kind: str, bad: int) -> None:
    """Frames before it are kept, whatever the engine hands over at once."""
    wrong = "COL r1\nOUT 2, r1" if kind == "list" else "OUT 2, r15"
    sends = "OUT 2, r15\n" * {"scalar16": 2, "picture": 64}.get(kind, 1)
    source = f"""
        .output it, 2, {kind}
                MOV r15, #255
        frame:  EXPOSE
                ADD r15, #1
                {sends}
                CMP r15, #{bad}
                JANY NE, frame
                {wrong}
                JMP frame
        """
    results = [
        chip_of(source, engine=engine).run(clip_of(90, SMALL)) for engine in ("wasm", "reference")
    ]
    for result in results:
        assert result.error is not None
        assert result.error.code == ("NP310" if kind == "list" else "NP311")
        assert (result.frames, result.last_complete) == (bad + 1, False)
        assert result.value("it", bad) is None
        assert all(result.value("it", k) is not None for k in range(bad))
    assert results[0].error == results[1].error
    assert results[0].frame_cycles.tolist() == results[1].frame_cycles.tolist()


@pytest.mark.parametrize("masked", [False, True])
def test_a_frame_begun_by_stepping_keeps_what_it_has_sent(masked: bool) -> None:
    sends = "CMP r2, #2\nWHERE LO\nOUT 3, r2\nEND" if masked else "OUT 3, r15"
    source = f"""
        .output all, 2, list
        .output last, 3, plane
                COL r2
        frame:  EXPOSE
                ADD r15, #1
                OUT 2, r15
                {sends}
                OUT 2, r15
                JMP frame
        """
    found = []
    for engine in ("wasm", "reference"):
        chip = chip_of(source, engine=engine)
        chip.feed(clip_of(5, SMALL))
        for _ in range(10 if masked else 7):
            chip.step()
        result = chip.run()
        found.append((result.setup.outputs["all"], plane(result.setup.outputs["last"])))
        assert result.outputs["all"] == [[k, k] for k in range(2, 6)]
    assert found[0] == found[1]
    assert found[0][0] == [1, 1]


SHAPES = {"scalar": (), "scalar16": (), "plane": (3, 4), "picture": (24, 32)}


@pytest.mark.parametrize("kind", OUTPUT_KINDS)
@pytest.mark.parametrize("frames", [0, 1, 3])
@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_results_without_values_have_the_shape_of_their_kind(
    kind: OutputKind, frames: int, engine: Literal["reference", "wasm"]
) -> None:
    """No frame, or frames that send nothing, give arrays of the same type and shape as others."""
    chip = chip_of(f".output it, 2, {kind}\nframe: EXPOSE\nJMP frame", SMALL, engine)
    result = chip.run(clip_of(frames, SMALL) if frames else None)
    column = result.outputs["it"]
    if kind == "list":
        assert column == [None] * frames
        return
    assert column.shape == (frames, *SHAPES[kind])
    assert column.dtype == (np.uint8 if KINDS[kind].form == "array" else np.int32)
    assert np.ma.isMaskedArray(column) == (frames > 0)
    assert np.ma.getmaskarray(column).all()
    assert not np.ma.getdata(column).any()
    assert [result.value("it", frame) for frame in range(frames)] == [None] * frames


def test_a_result_without_frames_does_not_name_ports_that_only_the_setup_used() -> None:
    result = chip_of("OUT 3, r1\nHALT").run()
    assert result.outputs == {}
    assert (result.frame_cycles.shape, result.frame_instructions.shape) == ((0,), (0,))
    assert plane(result.setup.outputs["port3"]) == [[0] * 4] * 3
