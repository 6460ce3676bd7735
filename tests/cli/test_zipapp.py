"""npchip runs from a zip archive that holds the package, its data with it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipapp
from pathlib import Path

import numpy as np
import pytest

import npchip

SOURCE = """\
; run: a frames=clip.npy
; expect: status == frames-exhausted
.output one, 0, scalar
x: EXPOSE
 SAMPLE signal, 128
 MOV r0, #1
 OUT 0, r0
 JMP x
"""


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("archive")
    site = folder / "site"
    package, unwanted = Path(npchip.__file__).parent, shutil.ignore_patterns("__pycache__")
    shutil.copytree(package, site / "npchip", ignore=unwanted)
    zipapp.create_archive(site, folder / "npchip.pyz", main="npchip.__main__:main")
    return folder / "npchip.pyz"


PICTURE = Path(__file__).parents[2] / "examples" / "orientation" / "shot0.png"
LONG = [
    "machine conservative",
    "asm p.s -o p.npo --listing",
    "disasm p.npo",
    "run p.npo --frames clip.npy --engine reference --json-to out --render out.png",
    "test p.s --junit out.xml",
    "profile p.s --frames clip.npy --lcov out.info --plot out.svg",
    "debug p.s --frames clip.npy --script steps",
    "compare p.s p.npo --frames clip.npy --machine default,conservative --chart out.png",
    "trace p.s --frames clip.npy --vcd out.vcd",
    "scene --shape dot --start 9,9 --velocity 0,1 -o out.gif",
    f"orient predict {PICTURE}",
]


@pytest.mark.long
@pytest.mark.parametrize(
    "command",
    ["isa ADD", "run p.s --frames clip.npy"]
    + [pytest.param(command, marks=pytest.mark.long) for command in LONG],
)
def test_a_command_runs_from_a_zip_archive(archive: Path, tmp_path: Path, command: str) -> None:
    """Data files were read by their paths, which an archive has not."""
    (tmp_path / "p.s").write_text(SOURCE)
    (tmp_path / "steps").write_text("step 3\n")
    np.save(tmp_path / "clip.npy", np.zeros((2, 64, 80), np.uint8))
    setup = "asm p.s -o p.npo"
    for words in [setup, command] if "p.npo" in command else [command]:
        done = subprocess.run(
            [sys.executable, archive, *words.split()],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path[1:])},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, (words, done.stdout, done.stderr)
