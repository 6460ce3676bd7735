"""Every command with closed streams, few file descriptors, little memory and a full disk."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests import signals

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="uses ulimit and /dev/full"),
]

EXAMPLES = Path(__file__).parents[2] / "examples"
COMMANDS = [
    *signals.COMMANDS,
    "--help",
    "isa",
    "machine",
    "completion bash",
    "asm p.s --listing --cycles",
    "disasm p.npo",
    "test q.s",
    "run p.s --frames shots --engine reference",
    "run p.s --frames clip.mkv --json",
    "profile p.s --frames clip.npy",
    "orient predict shot.png",
    "fuse --rig chip.yaml ball.1.gif ball.2.gif --plot out.png",
]
SURROUNDINGS = {
    "no input": "COMMAND <&-",
    "no output": "COMMAND >&-",
    "no errors": "COMMAND 2>&-",
    "no streams": "COMMAND <&- >&- 2>&-",
    "full output": "COMMAND >/dev/full",
    "full errors": "COMMAND 2>/dev/full",
    "8 descriptors": "ulimit -n 8; COMMAND",
    "16 descriptors": "ulimit -n 16; COMMAND",
    "4.4 GB": "ulimit -v 4400000; COMMAND",
    "0.8 GB": "ulimit -v 800000; COMMAND",
    "files of 1 KB": "ulimit -f 1; COMMAND",
}
WORKS = {"no input", "no output", "no errors", "no streams", "16 descriptors", "4.4 GB"}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a folder with what the commands read."""
    from tests.frames.test_video import written

    folder = tmp_path_factory.mktemp("place")
    signals.make_place(folder)
    (folder / "q.s").write_text("; run: a\n; expect: status == halted\n HALT\n")
    frames = list(np.load(folder / "clip.npy")[:3])
    (folder / "shots").mkdir()
    for number, frame in enumerate(frames):
        Image.fromarray(frame).save(folder / "shots" / f"{number}.png")
    written(folder / "clip.mkv", "ffv1", "gray", frames, "gray")
    shutil.copy(EXAMPLES / "orientation" / "shot0.png", folder / "shot.png")
    for name in ("ball.1.gif", "ball.2.gif", "chip.yaml"):
        shutil.copy(EXAMPLES / "rigs" / name, folder)
    return folder


def failure(place: Path, folder: Path, command: str, surroundings: str) -> str | None:
    """Run a command; return what is wrong, None if nothing."""
    shutil.copytree(place, folder)
    line = SURROUNDINGS[surroundings].replace(
        "COMMAND", f'exec "{sys.executable}" -m npchip {command}'
    )
    done = subprocess.run(
        ["bash", "-c", line],
        cwd=folder,
        env=signals.environment(),
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    codes = {0} if surroundings in WORKS else {0, 2}
    if done.returncode not in codes or "Traceback" in done.stderr:
        return f"{command}: {done.returncode}: {done.stderr[-500:]}"
    left = [path.name for path in folder.rglob("*.tmp")]
    return f"{command}: left {left}" if left else None


@pytest.mark.parametrize("surroundings", SURROUNDINGS)
def test_every_command_in_odd_surroundings(place: Path, tmp_path: Path, surroundings: str) -> None:
    found = [
        failure(place, tmp_path / str(number), command, surroundings)
        for number, command in enumerate(COMMANDS)
    ]
    assert [line for line in found if line] == []
