"""Whole runs from the command line, as users and scripts start them."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image

from npchip.cli.main import cli
from tests.oracles.trajectory import trajectory
from tests.support.clips import CLIPS, bundled_clips

ASM = Path(__file__).parents[2] / "asm"
COIN = str(CLIPS / "coin_slide.npy")


def npchip(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(item) for item in arguments])


def run(*arguments: object, exit_code: int = 0) -> dict[str, Any]:
    done = npchip("run", *arguments, "--json")
    assert done.exit_code == exit_code, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    return document


def source(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "program.s"
    file.write_text(text)
    return file


@pytest.mark.parametrize("machine", ["default", "conservative"])
def test_the_main_job(machine: str) -> None:
    clip = CLIPS / "ball_fall_30000fps.npy"
    document = run(ASM / "trajectory.s", "--frames", clip, "--machine", machine)
    assert document["schema"] == 1
    assert document["program"] == "trajectory"
    assert document["machine"] == machine
    assert document["status"] == "frames-exhausted"
    assert "error" not in document
    assert document["clock_hz"] == 10_000_000
    frames = document["frames"]
    assert [frame["index"] for frame in frames] == list(range(15))
    total = document["setup"]["cycles"] + sum(frame["cycles"] for frame in frames)
    assert document["cycles"] == total
    expected = trajectory(np.load(clip), 32)
    assert [frame["outputs"] for frame in frames] == [
        {name: values[k] for name, values in expected.items()} for k in range(15)
    ]


def test_a_constant_defined_on_the_command_line() -> None:
    document = run(ASM / "trajectory.s", "--frames", COIN, "--define", "THRESHOLD=0x08")
    expected = trajectory(bundled_clips()["coin_slide"], 8)["center_col"]
    assert [frame["outputs"]["center_col"] for frame in document["frames"]] == expected


def test_an_assembled_file_gives_the_same_result(tmp_path: Path) -> None:
    file = tmp_path / "trajectory.npo"
    assert npchip("asm", ASM / "trajectory.s", "-o", file).exit_code == 0
    assert run(file, "--frames", COIN) == run(ASM / "trajectory.s", "--frames", COIN)
    assert npchip("run", file, "--frames", COIN, "--define", "THRESHOLD=8").exit_code == 2


def test_a_raw_image_has_ports_without_names(tmp_path: Path) -> None:
    file = tmp_path / "trajectory.hex"
    assert npchip("asm", ASM / "trajectory.s", "-o", file).exit_code == 0
    document = run(file, "--frames", COIN)
    named = run(ASM / "trajectory.s", "--frames", COIN)
    for frame, other in zip(document["frames"], named["frames"], strict=True):
        assert list(frame["outputs"]) == [f"port{n}" for n in range(5)]
        assert frame["outputs"]["port2"][7][9] == other["outputs"]["center_col"]


def test_pictures_are_saved_and_named(tmp_path: Path) -> None:
    document = run(ASM / "imaging.s", "--frames", COIN, "--save", tmp_path / "out")
    saved = np.load(tmp_path / "out" / "picture.npy")
    np.testing.assert_array_equal(saved, bundled_clips()["coin_slide"])
    assert document["frames"][3]["outputs"] == {"picture": {"file": "picture.npy", "index": 3}}
    assert json.loads((tmp_path / "out" / "run.json").read_text()) == document


def test_frames_from_images_of_another_size(tmp_path: Path) -> None:
    clip = bundled_clips()["coin_slide"][4:9]
    for number, frame in enumerate(clip, start=8):  # natural order: 8, 9, 10, 11, 12
        large = np.kron(frame, np.ones((3, 3), np.uint8))
        Image.fromarray(large).save(tmp_path / f"shot{number}.png")
    refused = npchip("run", ASM / "trajectory.s", "--frames", tmp_path)
    assert refused.exit_code == 2
    assert "64" in refused.stderr
    assert "192" in refused.stderr
    document = run(ASM / "trajectory.s", "--frames", tmp_path, "--fit", "resize")
    expected = trajectory(clip, 32)["center_col"]
    assert [frame["outputs"]["center_col"] for frame in document["frames"]] == expected


def test_memory_is_scanned_in(tmp_path: Path) -> None:
    planes = np.arange(160, dtype=np.uint8).reshape(2, 8, 10)
    np.save(tmp_path / "table.npy", planes)
    text = ".output second, 0, plane\n LD r0, [0x41]\n OUT 0, r0\n HALT\n"
    document = run(source(tmp_path, text), "--memory", f"0x40={tmp_path / 'table.npy'}")
    assert document["setup"]["outputs"]["second"] == planes[1].tolist()
    assert document["frames"] == []


def test_of_two_memory_files_the_later_one_wins_where_both_write(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.full((2, 8, 10), 3))
    np.save(tmp_path / "b.npy", np.full((1, 8, 10), 4))
    text = ".output first, 0, scalar\n.output second, 1, scalar\n"
    text += " LD r0, [64]\n OUT 0, r0\n LD r0, [65]\n OUT 1, r0\n HALT\n"
    files = [("--memory", f"{at}={tmp_path / name}") for at, name in ((64, "a.npy"), (65, "b.npy"))]
    document = run(source(tmp_path, text), *files[0], *files[1])
    assert document["setup"]["outputs"] == {"first": 3, "second": 4}
    document = run(source(tmp_path, text), *files[1], *files[0])
    assert document["setup"]["outputs"] == {"first": 3, "second": 3}


def test_a_port_without_a_name_is_there_in_all_frames_or_in_none(tmp_path: Path) -> None:
    text = " OUT 9, r0\n EXPOSE\n EXPOSE\n OUT 5, r0\n JMP 2\n"
    document = run(source(tmp_path, text), "--frames", COIN)
    assert [*document["setup"]["outputs"]] == ["port9"]
    assert document["frames"][0]["outputs"] == {"port5": None}
    assert document["frames"][1]["outputs"] == {"port5": [[0] * 10] * 8}


def test_a_trap_names_address_and_line(tmp_path: Path) -> None:
    file = source(tmp_path, "        MOV r0, #1\n        RET\n")
    document = run(file, exit_code=1)
    assert document["status"] == "failed"
    error = document["error"]
    assert (error["code"], error["address"], error["line"]) == ("NP302", 1, 2)
    assert error["file"] == str(file)
    shown = npchip("run", file)
    assert shown.exit_code == 1
    assert f"{file}:2: error: " in shown.stderr


def test_outputs_that_disagree_name_two_nps(tmp_path: Path) -> None:
    text = ".output where, 3, scalar\n EXPOSE\n COL r0\n OUT 3, r0\n HALT\n"
    document = run(source(tmp_path, text), "--frames", COIN, exit_code=1)
    assert document["error"]["code"] == "NP310"
    assert "NP(0,0) sent 0 and NP(0,1) sent 1" in document["error"]["message"]
    assert document["error"]["line"] == 4


def test_an_endless_loop_reaches_the_limit(tmp_path: Path) -> None:
    file = source(tmp_path, "loop: JMP loop\n")
    document = run(file, "--max-cycles", "1000", exit_code=3)
    assert document["status"] == "cycle-limit"
    assert document["cycles"] == document["instructions"] == 1000


def test_a_cycle_budget_that_is_exceeded_fails_the_run(tmp_path: Path) -> None:
    text = (ASM / "imaging.s").read_text().replace(".budget cycles 1603", ".budget cycles 1602")
    file = source(tmp_path, text)
    document = run(file, "--frames", COIN, exit_code=1)
    assert document["error"]["code"] == "NP320"
    run(file, "--frames", COIN, "--machine", "conservative")  # only `default` is bounded


@pytest.mark.parametrize("suffix", ["gif", "png"])
def test_the_picture_shows_path_and_prediction(suffix: str, tmp_path: Path) -> None:
    file = tmp_path / f"coin.{suffix}"
    done = npchip("run", ASM / "trajectory.s", "--frames", COIN, "--render", file)
    assert done.exit_code == 0, done.output
    with Image.open(file) as image:
        assert getattr(image, "n_frames", 1) == (30 if suffix == "gif" else 1)
        if suffix == "gif":
            image.seek(10)
        pixels = np.asarray(image.convert("RGB")).astype(int).reshape(-1, 3)
    red, green, blue = pixels.T
    assert ((green > 150) & (red < 100) & (blue < 150)).sum() > 50
    assert ((red > 180) & (green < 110) & (blue < 110)).sum() > 50


def test_a_larger_machine_from_a_file(tmp_path: Path) -> None:
    machine = tmp_path / "large.yaml"
    machine.write_text("extends: default\ngeometry: {np_rows: 16, np_cols: 20}\n")
    frames = np.kron(bundled_clips()["coin_slide"][4:9], np.ones((1, 2, 2), np.uint8))
    np.save(tmp_path / "large.npy", frames)
    document = run(ASM / "trajectory.s", "--frames", tmp_path / "large.npy", "--machine", machine)
    expected = trajectory(frames, 32)["predicted_col"]
    assert [frame["outputs"]["predicted_col"] for frame in document["frames"]] == expected
    wrong = npchip("run", ASM / "trajectory.s", "--frames", COIN, "--machine", machine)
    assert wrong.exit_code == 2


def test_a_program_assembled_for_another_geometry_is_refused(tmp_path: Path) -> None:
    machine = tmp_path / "large.yaml"
    machine.write_text("extends: default\ngeometry: {np_rows: 16, np_cols: 20}\n")
    file = tmp_path / "t.npo"
    assert npchip("asm", ASM / "trajectory.s", "-o", file).exit_code == 0
    refused = npchip("run", file, "--frames", COIN, "--fit", "resize", "--machine", machine)
    assert refused.exit_code == 2
    assert "NP102" in refused.stderr


def test_a_pipe_that_closes_early_is_no_error() -> None:
    command = f"'{sys.executable}' -m npchip run '{ASM / 'trajectory.s'}' --frames '{COIN}'"
    script = f"set -o pipefail; {command} | head -1"
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)
    assert done.stdout.startswith("frame ")
    assert done.stderr == ""


@pytest.mark.parametrize("command", ["run", "compare", "profile", "trace"])
def test_frames_that_the_program_does_not_take_are_worth_a_warning(
    command: str, tmp_path: Path
) -> None:
    source = tmp_path / "p.s"
    source.write_text("ADD r0, #1\nHALT\n")
    done = npchip(command, source, "--frames", "coin_slide")
    assert done.exit_code == 0
    assert "warning" in done.stderr
    assert "[NP257]" in done.stderr
    assert "NP257" not in npchip(command, source).stderr


def test_frames_that_are_not_sampled_are_worth_a_warning(tmp_path: Path) -> None:
    source = tmp_path / "p.s"
    source.write_text("frame: EXPOSE\nJMP frame\n")
    assert "[NPW13]" in npchip("run", source, "--frames", "coin_slide").stderr
    source.write_text("frame: EXPOSE\nIN r0, 0\nJMP frame\n")  # in step with another camera
    assert "NPW13" not in npchip("asm", source).stderr
    source.write_text("SAMPLE signal, 0\nHALT\n")
    assert "[NPW14]" in npchip("asm", source).stderr
