"""Rare cases that the documents state, in both engines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pytest

from npchip import Chip, assemble_text, load_machine
from npchip.engines.base import Request
from npchip.machine import Sensor
from npchip.machine.sensor import SensorModel
from npchip.program.model import Program
from tests.support.chips import FILE, clip_of, machine_of, word

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Engine = Literal["reference", "wasm"]

MACHINE = machine_of()
both = pytest.mark.parametrize("engine", ["reference", "wasm"])


def chip(source: str, engine: Engine, **changes: Any) -> Chip:
    machine = machine_of(**changes)
    return Chip(assemble_text(source, FILE, machine), machine, engine)


@both
def test_a_halt_counts_its_cycle_and_leaves_the_pc_behind_it(engine: Engine) -> None:
    halted = chip("NOP\nHALT\nNOP\nHALT", engine)
    result = halted.run()
    assert (result.status, result.cycles, result.setup.complete) == ("halted", 2, True)
    assert (halted.pc, halted.instructions) == (2, 2)
    again = halted.run()
    assert (again.status, again.cycles, halted.pc) == ("halted", 0, 2)


@both
def test_without_a_frame_the_pc_stays_at_the_expose_and_nothing_is_counted(engine: Engine) -> None:
    ended = chip("NOP\nEXPOSE\nOUT 0, r0\nJMP 1", engine)
    result = ended.run(clip_of(2, MACHINE))
    assert (result.status, result.frames, ended.pc) == ("frames-exhausted", 2, 1)
    assert ended.executions.tolist() == [1, 2, 2, 2]
    assert result.cycles == result.setup.cycles + result.frame_cycles.sum()


@both
def test_all_is_setup_without_an_expose(engine: Engine) -> None:
    result = chip(".output n, 0, scalar\nOUT 0, r0\nHALT", engine).run()
    assert result.frames == 0
    assert (result.setup.cycles, result.setup.outputs) == (result.cycles, {"n": 0})


@both
@pytest.mark.parametrize(
    "last",
    ["RET", ".word 0", "IN r1, 4", "CALL 0"],
    ids=["no call", "undefined word", "no partner", "calls too deep"],
)
def test_an_instruction_that_traps_costs_and_counts_nothing(last: str, engine: Engine) -> None:
    calls = last.startswith("CALL")
    trapped = chip(f"NOP\n{last}\nHALT", engine)
    result = trapped.run()
    rounds = MACHINE.stack_depth + 1 if calls else 1  # each with the NOP, the last without a CALL
    assert (result.status, trapped.pc) == ("failed", 1)
    assert result.cycles == trapped.instructions == 2 * rounds - 1
    assert trapped.executions.tolist() == [rounds, rounds - 1, 0]
    assert not result.setup.complete


@both
@pytest.mark.parametrize("name", ["ELSE", "END"])
def test_a_mask_that_is_not_open_is_a_trap_with_its_code(name: str, engine: Engine) -> None:
    result = Chip(Program("raw", (word("NOP"), word(name))), MACHINE, engine).run()
    assert result.error is not None
    assert (result.error.code, result.error.address, result.cycles) == ("NP304", 1, 1)


@both
def test_the_end_of_a_program_is_its_last_word_not_that_of_the_rom(engine: Engine) -> None:
    ran_on = chip("NOP\nNOP", engine)
    result = ran_on.run()
    assert len(ran_on.program.words) < MACHINE.rom_words
    assert result.error is not None
    assert (result.error.code, result.error.address, result.cycles) == ("NP305", 2, 2)


@both
def test_a_program_that_fills_the_rom_does_not_begin_anew_behind_its_end(engine: Engine) -> None:
    full = Chip(Program("raw", (word("NOP"),) * 512), MACHINE, engine)
    result = full.run()
    assert result.error is not None
    assert (result.error.code, result.error.address, result.cycles) == ("NP305", 512, 512)
    assert full.pc == 512


@both
def test_an_end_takes_nothing_from_a_counter_of_0(engine: Engine) -> None:
    """Within a region that all NPs met, their counters are 0 and stay so."""
    masked = chip("CMP r0, r0\nWHERE EQ\nEND\nWHERE NE\nEND\nMOV r1, #7\nHALT", engine)
    assert masked.run().status == "halted"
    assert masked.active.all()
    assert (masked.registers[1] == 7).all()


@both
def test_an_else_leaves_counters_above_1(engine: Engine) -> None:
    """NPs that an outer region has switched off stay off in both branches of an inner one."""
    masked = chip(
        """
        COL     r2
        CMP     r2, #2
        WHERE   LO                      ; columns 0 and 1
          CMP   r2, #0
          WHERE EQ                      ; column 0
          ELSE
            MOV r1, #7                  ; column 1
          END
        END
        HALT
        """,
        engine,
    )
    masked.run()
    assert masked.registers[1].tolist() == [[0, 7, 0, 0]] * MACHINE.np_rows


@both
def test_an_input_without_an_active_np_still_takes_a_byte(engine: Engine) -> None:
    asked: list[int] = []

    def partner(request: Request) -> NDArray[np.uint8]:
        asked.append(request.index)
        return np.full(MACHINE.geometry, 10 + request.index, np.uint8)

    source = "EXPOSE\nCMP r0, #1\nWHERE EQ\nIN r1, 3\nEND\nIN r2, 3\nHALT"
    hearing = chip(source, engine)
    hearing.connect(partner)
    hearing.run(clip_of(1, MACHINE))
    assert sorted({*asked}) == [0, 1]
    assert not hearing.registers[1].any()
    assert (hearing.registers[2] == 11).all()
    deaf = chip(source, engine).run(clip_of(1, MACHINE))
    assert deaf.error is not None
    assert (deaf.error.code, deaf.error.address) == ("NP306", 3)


@both
def test_a_sample_without_an_active_np_counts_as_a_conversion(engine: Engine) -> None:
    sensor = Sensor(fixed_pattern=0, noise_rms=4.0, seed=9)
    clip = np.full((1, MACHINE.rows, MACHINE.cols), 100, np.uint8)
    read = []
    for masked in ("WHERE NE\nSAMPLE signal, 0\nEND\n", "SAMPLE signal, 0\n", ""):
        sampled = chip(
            f"CMP r0, r0\nEXPOSE\n{masked}SAMPLE signal, 64\nHALT", engine, sensor=sensor
        )
        sampled.run(clip)
        read.append(sampled.memory[64:128].tolist())
    assert read[0] == read[1] != read[2]


@both
def test_conversions_count_from_0_since_the_expose_and_frames_from_the_reset(
    engine: Engine,
) -> None:
    sensor = Sensor(fixed_pattern=0, noise_rms=4.0, seed=9)
    clip = np.full((2, MACHINE.rows, MACHINE.cols), 100, np.uint8)
    reset = ["SAMPLE reset, 0", "EXPOSE", "SAMPLE reset, 64", "EXPOSE"]
    sampled = chip(
        "\n".join([*reset, "SAMPLE reset, 128", "SAMPLE reset, 192", "HALT"]), engine, sensor=sensor
    )
    sampled.run(clip)
    noise = SensorModel(sensor, *MACHINE.geometry)
    for bank, frame, conversion in ((0, 0, 0), (64, 1, 0), (128, 2, 0), (192, 2, 1)):
        expected = noise.sample(False, None, frame, conversion)
        np.testing.assert_array_equal(sampled.memory[bank : bank + 64], expected)


LIMITS = [  # source, limit, how the run ends, cycles of the frame, pc
    ("EXPOSE\nNOP\nNOP\nHALT", 4, "halted", 4, 4),
    ("EXPOSE\nNOP\nNOP\nHALT", 3, "cycle-limit", 3, 3),
    ("EXPOSE\nNOP\nJMP 0", 3, "frames-exhausted", 3, 0),
    ("EXPOSE\nNOP\nJMP 0", 2, "cycle-limit", 2, 2),
    ("EXPOSE\nSAMPLE signal, 0\nNOP\nHALT", 5, "cycle-limit", 257, 2),  # the last one goes over
    ("EXPOSE\nSAMPLE signal, 0\nEXPOSE\nHALT", 256, "cycle-limit", 257, 2),
    ("EXPOSE\nSAMPLE signal, 0\nEXPOSE\nHALT", 257, "frames-exhausted", 257, 2),
]


@both
@pytest.mark.parametrize("case", LIMITS)
def test_a_frame_stops_before_the_instruction_that_finds_its_limit_reached(
    case: tuple[str, int, str, int, int], engine: Engine
) -> None:
    """An EXPOSE at just the limit is no part of the frame; a halted chip stays halted."""
    source, limit, status, cycles, pc = case
    limited = chip(source, engine)
    result = limited.run(clip_of(1, MACHINE), max_cycles=limit)
    assert (result.status, result.frame_cycles.tolist(), limited.pc) == (status, [cycles], pc)


@both
def test_a_halt_that_takes_longer_than_what_is_left_still_halts(engine: Engine) -> None:
    machine = machine_of(timing={**load_machine("default").timing, "control": 5})
    program = assemble_text("EXPOSE\nHALT", FILE, machine)
    result = Chip(program, machine, engine).run(clip_of(1, machine), max_cycles=6)
    assert (result.status, result.frame_cycles.tolist()) == ("halted", [10])


@both
def test_a_port_that_is_always_silent_is_absent(engine: Engine) -> None:
    source = "CMP r0, #9\nEXPOSE\nJANY EQ, 5\nOUT 3, r0\nJMP 1\nOUT 4, r0\nHALT"
    result = chip(source, engine).run(clip_of(2, MACHINE))
    assert set(result.outputs) == {"port3"}
    assert result.setup.outputs == {}


def test_a_send_names_the_active_nps_only_inside_masked_regions() -> None:
    """There also if all NPs are active."""
    sending = chip("OUT 0, r0\nCMP r0, r0\nWHERE EQ\nOUT 1, r0\nEND\nHALT", "wasm")
    while sending.step() is None:
        pass
    first, second = sending.sends
    assert first.active is None
    assert second.active is not None
    assert second.active.all()


@both
def test_addresses_wrap_at_the_end_of_a_smaller_memory(engine: Engine) -> None:
    small = chip("MOV r1, #70\nMOV r2, #5\nST [r1], r2\nLD r3, [6]\nHALT", engine, memory_bytes=64)
    small.run()
    assert (small.registers[3] == 5).all()
