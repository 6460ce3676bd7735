"""``npchip compare`` against counts by hand and against ``npchip run``."""

from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from npchip import Chip, Program, assemble, assemble_text, load_machine
from npchip.cli import output
from npchip.engines.wasm import translation
from npchip.engines.wasm.translate import graph
from npchip.engines.wasm.translate.steps import Block, TooLargeError
from npchip.isa import load_isa
from npchip.profile.tasks import TASKS, cycles_by_task
from tests.support.commands import invoke

ROOT = Path(__file__).parents[2]
CLIP = ROOT / "examples" / "clips" / "shapes_drawn.npy"
IMAGING, TRAJECTORY = ROOT / "asm" / "imaging.s", ROOT / "asm" / "trajectory.s"


def columns(*arguments: str | Path) -> list[dict[str, object]]:
    result = invoke("compare", *arguments, "--json")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["schema"] == 1
    found: list[dict[str, object]] = document["columns"]
    return found


def test_counts_by_hand(tmp_path: Path) -> None:
    """One frame: 3 moves and alu, a store of 2, a sample of 512, a jump; then HALT, an output."""
    source = tmp_path / "hand.s"
    source.write_text(
        "        EXPOSE\n        SAMPLE  signal, 0\n        MOV     r0, #2\n"
        ".again: ST      [5], r0\n        SUB     r0, #1\n        JANY    NE, .again\n"
        "        NBR     r1, r0, east\n        OUT     0, r0\n        HALT\n"
    )
    (column,) = columns(source, "--machine", "conservative", "--frames", CLIP)
    assert column["cycles_by_task"] == {
        "sampling": 512,
        "compute": 1 + 2,
        "memory": 2 * 2,
        "reduction": 2 * 4 + 2,
        "flow": 1 + 1,
        "output": 16,
        "other": 0,
    }
    assert column["cycles"] == 512 + 3 + 4 + 10 + 2 + 16
    assert column["words"] == 9
    assert column["words_left"] == 503
    assert column["frames"] == 1


@pytest.mark.parametrize("machine", ["default", "conservative"])
def test_the_tasks_add_up_and_the_run_is_that_of_run(machine: str) -> None:
    for program, column in zip(
        (TRAJECTORY, IMAGING),
        columns(TRAJECTORY, IMAGING, "--frames", CLIP, "--machine", machine),
        strict=True,
    ):
        result = invoke("run", program, "--frames", CLIP, "--machine", machine, "--json")
        run = json.loads(result.stdout)
        cycles = [frame["cycles"] for frame in run["frames"]]
        tasks = column["cycles_by_task"]
        assert isinstance(tasks, dict)
        assert sum(tasks.values()) == column["cycles"] == run["cycles"]
        assert column["instructions"] == run["instructions"]
        assert column["setup_cycles"] == run["setup"]["cycles"]
        assert column["cycles_per_frame"] == {
            "mean": pytest.approx(sum(cycles) / len(cycles)),
            "worst": max(cycles),
        }


def test_a_stated_clock_gives_frame_rates(tmp_path: Path) -> None:
    """`--clock` was no option of compare, and a larger array took as many cycles."""
    large = tmp_path / "large.yaml"
    large.write_text("extends: default\ngeometry: {np_rows: 16, np_cols: 10}\n")
    given = (IMAGING, "--frames", CLIP, "--fit", "resize", "--machine", f"default,{large}")
    first, second = columns(*given, "--clock", "20M")
    assert (first["frames_per_second"], second["frames_per_second"]) == (
        20e6 / 1603,
        20e6 / (1603 + 64 * 8),
    )
    shown = invoke("compare", *given, "--clock", "20M").stdout
    line = next(line for line in shown.splitlines() if line.startswith("frames/s"))
    assert line.split() == ["frames/s", "at", "20", "MHz,", "mean", "12,477", "9,456"]
    assert "frames/s" not in invoke("compare", *given).stdout


def test_every_timing_class_has_one_task() -> None:
    named = [name for classes in TASKS.values() for name in classes]
    assert sorted(named) == sorted(load_isa().timing_classes)


def test_executions_are_counted_restored_and_reset() -> None:
    chip = Chip(assemble_text("MOV r0, #3\nloop: SUB r0, #1\nJANY NE, loop\nEXPOSE\nHALT\n"))
    for _ in range(4):
        chip.step()
    before = chip.snapshot()
    assert chip.executions.tolist() == [1, 2, 1, 0, 0]
    assert chip.executions.dtype == np.int64
    result = chip.run()
    assert result.status == "frames-exhausted"
    assert chip.executions.tolist() == [1, 3, 3, 0, 0]
    assert chip.executions.sum() == chip.instructions
    chip.restore(before)
    assert chip.executions.tolist() == [1, 2, 1, 0, 0]
    chip.run(np.zeros((1, 64, 80), np.uint8))
    assert chip.executions.tolist() == [1, 3, 3, 1, 1]
    chip.reset()
    assert not chip.executions.any()


def test_a_class_of_ones_own_is_other() -> None:
    text = (ROOT / "src" / "npchip" / "isa" / "npchip.yaml").read_text()
    from npchip.isa import parse_isa

    isa = parse_isa(text.replace("timing: neighbour", "timing: link", 1), "own.yaml")
    program = assemble_text("NBR r0, r1, east\nHALT\n", isa=isa)
    chip = Chip(program, isa=isa)
    chip.run()
    tasks = cycles_by_task(program, load_machine("default"), isa, chip.executions)
    assert tasks["other"] == tasks["flow"] == 1
    assert tasks["reduction"] == 0


def test_the_table_names_programs_machines_and_ratios() -> None:
    result = invoke(
        "compare", IMAGING, TRAJECTORY, "--frames", CLIP, "--machine", "default,conservative"
    )
    lines = {
        re.split(r"\s{2,}", line.strip())[0]: re.split(r"\s{2,}", line.strip())[1:]
        for line in result.output.splitlines()
    }
    assert lines["program"] == ["imaging", "imaging", "trajectory", "trajectory"]
    assert lines["machine"] == ["default", "conservative"] * 2
    assert lines["words"] == ["15", "15", "174", "174"]
    assert lines["ratio to the first"][0] == "1.000"
    worst = [int(cell.replace(",", "")) for cell in lines["cycles per frame, worst"]]
    assert worst[:2] == [1603, 2948]
    shares = [
        float(cells[0].removesuffix(" %"))
        for name, cells in lines.items()
        if name in {*TASKS} and cells
    ]
    assert sum(shares) == pytest.approx(100, abs=0.4)


def test_programs_without_frames_and_with_one_name(tmp_path: Path) -> None:
    for name, text in (("a", "NOP\nHALT\n"), ("b", "HALT\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "same.s").write_text(text)
    files = [tmp_path / name / "same.s" for name in "ab"]
    result = invoke("compare", *files)
    assert result.exit_code == 0
    assert str(files[0]) in result.output
    assert re.search(r"^cycles, mean +2\.0 +1\.0$", result.output, re.MULTILINE)
    assert re.search(r"^ratio to the first +1\.000 +0\.500$", result.output, re.MULTILINE)


def test_an_assembled_file_and_a_definition(tmp_path: Path) -> None:
    object_file = tmp_path / "t.npo"
    assert invoke("asm", TRAJECTORY, "-o", object_file).exit_code == 0
    first, second = columns(TRAJECTORY, object_file, "--frames", CLIP)
    assert first["cycles"] == second["cycles"]
    (other,) = columns(TRAJECTORY, "--frames", CLIP, "--define", "THRESHOLD=255")
    chip = Chip(assemble(TRAJECTORY, defines={"THRESHOLD": 255}))
    assert other["cycles"] == chip.run(np.load(CLIP)).cycles


def test_a_program_that_fails_or_does_not_end(tmp_path: Path) -> None:
    good, bad, endless = (tmp_path / f"{name}.s" for name in ("good", "bad", "endless"))
    good.write_text("HALT\n")
    bad.write_text("RET\n")
    endless.write_text("loop: JMP loop\n")
    result = invoke("compare", good, bad, "--machine", "default")
    assert result.exit_code == 1
    assert "halted" in result.stdout
    assert "failed" in result.stdout
    assert "NP302" in result.stderr
    result = invoke("compare", good, endless, "--max-cycles", "1000")
    assert result.exit_code == 3
    assert "endless on machine default reached the limit of 1,000 cycles [NP321]" in result.stderr


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ([TRAJECTORY], "NP246"),
        ([TRAJECTORY, TRAJECTORY], "NP290"),
        ([TRAJECTORY, "--machine", "default,default"], "NP290"),
        ([TRAJECTORY, "--machine", "default,"], "NP202"),
        ([TRAJECTORY, "--machine", "defalt"], "NP202"),
        ([TRAJECTORY, "--chart", "x.jpg"], "NP292"),
        ([TRAJECTORY, "--chart", "no/such/x.png"], "NP250"),
        ([TRAJECTORY, "nosuch.s", "--frames", CLIP], "NP025"),
        ([IMAGING, "--frames", CLIP, "--define", "THRESHOLD=3"], "NP026"),
    ],
)
def test_mistakes(options: list[str | Path], code: str) -> None:
    result = invoke("compare", *options)
    assert result.exit_code == 2
    assert f"[{code}]" in result.stderr


@pytest.mark.skipif(importlib.util.find_spec("matplotlib") is None, reason="no Matplotlib")
def test_the_chart_has_the_colours_of_the_tasks(tmp_path: Path) -> None:
    chart = tmp_path / "chart.png"
    assert invoke("compare", IMAGING, "--frames", CLIP, "--chart", chart).exit_code == 0
    image = np.asarray(Image.open(chart).convert("RGB"))
    widths = {}
    for name, color in (("sampling", (0, 114, 178)), ("output", (0, 158, 115))):
        columns_of = (image == color).all(axis=2).sum(axis=0)
        widths[name] = int((columns_of > 25).sum())  # not the legend's small square
    assert widths["sampling"] > 100
    assert abs(widths["sampling"] - widths["output"]) <= 3  # both take 512 cycles


@pytest.mark.skipif(importlib.util.find_spec("matplotlib") is None, reason="no Matplotlib")
def test_the_same_svg_every_time(tmp_path: Path) -> None:
    charts = [tmp_path / "a.svg", tmp_path / "b.svg"]
    for chart in charts:
        options = ("--machine", "default,conservative", "--frames", CLIP, "--chart", chart)
        assert invoke("compare", IMAGING, TRAJECTORY, *options).exit_code == 0
    assert charts[0].read_bytes() == charts[1].read_bytes()


def test_without_matplotlib_there_is_a_remedy(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(output, "find_spec", lambda _name: None)
    result = invoke("compare", IMAGING, "--frames", CLIP, "--chart", tmp_path / "x.png")
    assert result.exit_code == 2
    assert "[NP291]" in result.stderr
    assert "npchip[plot]" in result.stderr


def test_it_is_said_which_programs_the_reference_engine_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def build(program: Program, *args: Any) -> list[Block]:
        if program.name == "imaging":
            raise TooLargeError("it is too large")
        return graph.build(program, *args)

    monkeypatch.setattr(translation, "build", build)
    result = invoke("compare", IMAGING, TRAJECTORY, "--frames", CLIP)
    assert result.exit_code == 0
    (note,) = [line for line in result.stderr.splitlines() if line.startswith("note: ")]
    assert note.startswith("note: imaging on machine default: it is too large: the reference")
