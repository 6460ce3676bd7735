"""No command writes over what it reads, or waits for what is no file."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image

from npchip.base.errors import InputError
from npchip.cli.main import cli
from npchip.frames.memory import read_memory
from npchip.machine import load_machine

SOURCE = """.output sum, 0, plane
.include "part.inc"
frame: EXPOSE
 SAMPLE signal, 0
 LD r0, [0]
 OUT 0, r0
 JMP frame
"""


def npchip(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(item) for item in arguments])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a program and all that it is run on, in which commands are given."""
    monkeypatch.chdir(tmp_path)
    Path("p.s").write_text(SOURCE)
    Path("part.inc").write_text(".equ K, 1\n")
    Path("link").symlink_to("p.s")
    Path("hard").hardlink_to("p.s")
    np.save("clip.npy", np.zeros((2, 64, 80), np.uint8))
    np.save("sum.npy", np.zeros((2, 64, 80), np.uint8))
    np.save("w.npy", np.zeros((1, 8, 10), np.uint8))
    Path("m.yaml").write_text("extends: default\n")
    Path("i.yaml").write_text("extends: npchip\n")
    Path("scene.yaml").write_text("objects: [{shape: disc, radius: 3, start: [9, 9]}]\n")
    Path("test_t.s").write_text(f"; run: a frames=clip.npy\n; expect: golden\n{SOURCE}")
    assert npchip("test", "test_t.s", "--update").exit_code == 0
    assert npchip("asm", "p.s", "-o", "p.npo").exit_code == 0
    return tmp_path


RUN = ("p.s", "--frames", "clip.npy")


@pytest.mark.parametrize(
    "arguments",
    [
        *(("run", *RUN, "--json-to", name) for name in ("p.s", "link", "hard", "./p.s")),
        *(("run", *RUN, "--json-to", name) for name in ("clip.npy", "part.inc")),
        ("run", *RUN, "--memory", "100=w.npy", "--json-to", "w.npy"),
        ("run", *RUN, "--machine", "m.yaml", "--json-to", "m.yaml"),
        ("run", "p.s", "--frames", "sum.npy", "--save", "."),
        ("run", *RUN, "--json-to", "run.json", "--save", "."),
        ("asm", "p.npo", "-o", "p.npo"),
        ("disasm", "p.npo", "-o", "p.npo"),
        ("profile", *RUN, "--lcov", "p.s"),
        ("profile", *RUN, "--lcov", "x", "--speedscope", "x"),
        ("test", "test_t.s", "--junit", "clip.npy"),
        ("test", "test_t.s", "--junit", "test_t.golden.json"),
        ("test", "test_t.s", "--junit", "test_t.s", "--update"),
    ],
    ids=" ".join,
)
def test_an_output_that_the_command_reads_is_refused(
    folder: Path, arguments: tuple[str, ...]
) -> None:
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    done = npchip(*arguments)
    assert done.exit_code == 2, done.output
    assert "[NP254]" in done.output, done.output
    assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before


@pytest.mark.usefixtures("folder")
def test_pictures_of_a_folder_are_not_written_over() -> None:
    for name in ("1.png", "2.png"):
        Image.new("L", (80, 64)).save(name)
    before = Path("2.png").read_bytes()
    for clip in ("*.png", "."):
        done = npchip("run", "p.s", "--frames", clip, "--json-to", "2.png")
        assert (done.exit_code, "NP254" in done.output) == (2, True), done.output
    assert Path("2.png").read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("run", "pipe"), "NP025"),
        (("run", "pipe.npo"), "NP115"),
        (("run", *RUN, "--memory", "0=pipe"), "NP243"),
        (("run", *RUN, "--isa", "pipe"), "NP401"),
        (("debug", *RUN, "--script", "pipe"), "NP353"),
        (("debug", *RUN, "--script", "p.s", "--breakpoints", "pipe"), "NP355"),
        (("test", "pipe.s"), "NP025"),
        (("orient", "predict", "x.png", "--network", "pipe"), "NP456"),
        (("orient", "predict", "x.png", "--angles", "pipe"), "NP457"),
    ],
    ids=str,
)
def test_a_pipe_is_refused_at_once(folder: Path, arguments: tuple[str, ...], code: str) -> None:
    for name in ("pipe", "pipe.npo", "pipe.s"):
        os.mkfifo(folder / name)
    done = npchip(*arguments)
    assert done.exit_code == 2
    assert code in done.output
    assert "not a regular file" in done.output


def test_what_is_no_array_for_memory_is_called_by_its_name(tmp_path: Path) -> None:
    machine = load_machine("default")
    file = tmp_path / "w.npy"
    planes = np.zeros((2, 8, 10), np.uint8)
    with file.open("wb") as stream:
        np.savez(stream, w=planes)
    for content, kind in ((file.read_bytes(), "an archive of arrays"), (b"GIF89a", "not a NumPy")):
        file.write_bytes(content)
        with pytest.raises(InputError, match=f"{kind}.*expected one .npy array.*NP243"):
            read_memory(0, file, machine)
    for wrong in (planes - 1.5, planes.astype(bool), planes.astype(np.int16) - 1):
        np.save(file, wrong)
        with pytest.raises(InputError, match=f"values are {wrong.dtype}.*NP243"):
            read_memory(0, file, machine)


def test_the_header_of_memory_is_checked_before_memory_is_taken(tmp_path: Path) -> None:
    file = tmp_path / "w.npy"
    machine = load_machine("default")
    with file.open("wb") as stream:
        np.lib.format.write_array_header_1_0(
            stream, {"descr": "|u1", "fortran_order": False, "shape": (10**12, 8, 10)}
        )
        stream.truncate(1 << 40)  # a sparse file: it takes no room
    with pytest.raises(InputError, match=r"shape is \(1000000000000, 8, 10\).*NP243"):
        read_memory(0, file, machine)
    planes = np.arange(160, dtype=np.uint8).reshape(2, 8, 10)
    for array in (planes, np.asfortranarray(planes), planes.astype(">i8")):
        np.save(file, array)
        assert np.array_equal(read_memory(0, file, machine), planes)
    file.write_bytes(file.read_bytes() * 2)  # two arrays in one file
    with pytest.raises(InputError, match=r"the file holds .*NP243"):
        read_memory(0, file, machine)
    file.write_bytes(b"\x93NUMPY\x02\x00\xff\xff\xff\x7f" + bytes(100))
    with pytest.raises(InputError, match="NP243"):
        read_memory(0, file, machine)


def test_the_truth_about_another_clip_is_kept(tmp_path: Path) -> None:
    scene = ("scene", "--shape", "dot", "--start", "9,9", "--velocity", "0,1", "--frames", "2")
    for name in ("z.npy", "z.npy", "y.gif"):  # once more, and another clip
        assert npchip(*scene, "-o", tmp_path / name).exit_code == 0
    before = (tmp_path / "z.truth.json").read_bytes()
    done = npchip(*scene, "--seed", "2", "-o", tmp_path / "z.gif")
    assert (done.exit_code, "NP255" in done.output) == (2, True), done.output
    assert (tmp_path / "z.truth.json").read_bytes() == before
    assert not (tmp_path / "z.gif").exists()


def test_goldens_that_two_processes_record_at_once_are_both_kept(tmp_path: Path) -> None:
    source = tmp_path / "x.s"
    runs = "".join(f"; run: r{k} levels={k}\n; expect: golden\n" for k in range(3))
    source.write_text(f"{runs}.output o, 0, plane\nl: EXPOSE\n MOV r0, #1\n OUT 0, r0\n JMP l\n")
    command = [sys.executable, "-m", "npchip", "test", str(source), "--update", "-k"]
    env = {name: value for name, value in os.environ.items() if name != "CI"}
    both = [subprocess.Popen([*command, f"r{k}"], env=env, stdout=-3) for k in range(3)]
    assert [process.wait() for process in both] == [0, 0, 0]
    assert npchip("test", source).exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.golden.json", "x.s"]


def test_a_source_whose_golden_could_have_no_name_is_tested(tmp_path: Path) -> None:
    source = tmp_path / f"{'x' * 250}.s"
    source.write_text("; run: a\n; expect: status == halted\n HALT\n")
    assert npchip("test", source).exit_code == 0
