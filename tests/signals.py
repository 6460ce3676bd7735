"""Signals at random moments from npchip's first line on: exit codes, files, and nothing else.

``python -m tests.signals --count 50`` sends each signal so often to each command and says what went
wrong; ``--start`` sends them while Python itself starts, and counts what that leaves.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final

CODES: Final = {"SIGINT": 130, "SIGTERM": 143, "SIGHUP": 129}
ROOT = Path(__file__).parents[1]
_SLOW = 0.5
"""Seconds after a signal within which a process that ends as if it had none had ended before."""

_SOURCE = """\
; run: a frames=clip.npy
; expect: golden
.output seen, 0, plane
.output pictures, 1, picture
x:  EXPOSE
    SAMPLE signal, 128
    MOV r1, #128
    .rept 64
    LD  r0, [r1]
    OUT 1, r0
    ADD r1, #1
    .endr
    OUT 0, r0
    JMP x
"""
_DRAW = "scene --shape disc --radius 5 --start 9,9 --velocity 1,1 --frames 40 --noise 9"
COMMANDS: Final = [
    "run p.s --frames clip.npy --json-to out.json",
    "run p.s --frames clip.npy --save out",
    "run p.s --frames clip.npy --save out --json-to out.json --render out.gif",
    "run p.s --frames clip.npy --render out.png",
    "test p.s --update",
    "test p.s --update --junit out.xml",
    f"{_DRAW} -o out.npy",
    f"{_DRAW} -o out.gif",
    "asm p.s -o out.npo",
    "asm p.s -o out.hex",
    "disasm p.npo -o out.s",
    "profile p.s --frames clip.npy --lcov out.info --speedscope out.json",
    "profile p.s --frames clip.npy --plot out.svg",
    "compare p.s p.npo --frames clip.npy --machine default,conservative --chart out.svg",
    "trace p.s --frames clip.npy --vcd out.vcd",
    "trace p.s --frames clip.npy --limit 3000 --json",
    "debug p.s --frames clip.npy --script steps",
]

_START = """\
import os, sys
os.write({write}, b".")
from npchip.__main__ import main
main()
"""


def make_place(folder: Path) -> None:
    """Write what the commands read."""
    (folder / "p.s").write_text(_SOURCE)
    (folder / "steps").write_text("frame 3\nstep 5\nrun\n")
    for command in (f"{_DRAW} -o clip.npy", "asm p.s -o p.npo", "test p.s --update"):
        words = [sys.executable, "-m", "npchip", *command.split()]
        subprocess.run(words, cwd=folder, env=environment(), check=True, capture_output=True)
    (folder / "p.golden.json").unlink()


def environment() -> dict[str, str]:
    """Return the environment of the commands: one that may update goldens."""
    return {name: value for name, value in os.environ.items() if name != "CI"}


def _files(folder: Path) -> dict[str, bytes]:
    found = (path for path in folder.rglob("*") if path.is_file())
    return {
        str(path.relative_to(folder)): re.sub(rb'time="[^"]*"', b"", path.read_bytes())
        for path in found
    }


class Trial:
    """A command in a folder of its own, to be ended by signals.

    Args:
        place: a folder with what the command reads.
        command: its arguments.
    """

    def __init__(self, place: Path, command: str) -> None:
        self.place = place
        self.command = command
        self.before = _files(place)
        code, errors, self.after, self.seconds, _ = self._run(None, 0, own_start=False)
        assert code == 0, (command, errors)

    def failure(self, name: str, share: float, *, own_start: bool = False) -> str | None:
        """Send a signal after a share of the command's time; return what is wrong, None if nothing.

        Args:
            name: of the signal.
            share: 0 to 1.
            own_start: whether the time begins with Python's, not with npchip's first line.
        """
        code, errors, files, _, late = self._run(name, share * self.seconds, own_start=own_start)
        wrong = [
            file
            for file, data in files.items()
            if data not in (self.before.get(file), self.after.get(file))
        ]
        lost = set(self.before) - set(files)
        if wrong or lost:
            return f"files: {', '.join(sorted({*wrong, *lost}))}"
        if code == 0 and files == self.after and late < _SLOW:
            return None  # it had ended
        if code != CODES[name]:
            return f"exit code {code}: {errors[-300:]}"
        return None if errors.split() == ["interrupted"] else f"said {errors[-300:]}"

    def _run(
        self, name: str | None, delay: float, *, own_start: bool
    ) -> tuple[int, str, dict[str, bytes], float, float]:
        """Run the command once; return its end, and the seconds in all and after the signal."""
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(self.place, folder, dirs_exist_ok=True)
            read, write = os.pipe()
            process = subprocess.Popen(
                [sys.executable, "-c", _START.format(write=write), *self.command.split()],
                cwd=folder,
                env=environment(),
                pass_fds=[write],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
            os.close(write)
            if not own_start:
                os.read(read, 1)
            begin = sent = time.monotonic()
            if name is not None:
                time.sleep(delay)
                sent = time.monotonic()
                process.send_signal(getattr(signal, name))
            errors = process.communicate(timeout=120)[1]
            end = time.monotonic()
            os.close(read)
            return process.returncode, errors, _files(Path(folder)), end - begin, end - sent


def failures(
    commands: Sequence[str], count: int, seed: int, *, own_start: bool = False
) -> list[str]:
    """Send each signal `count` times to each command; return a line for each that went wrong."""
    rng = random.Random(seed)
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        make_place(Path(folder))
        for command in commands:
            trial = Trial(Path(folder), command)
            for name in sorted(CODES) * count:
                share = rng.random() * (0.1 if own_start else 1)
                found = trial.failure(name, share, own_start=own_start)
                if found is not None:
                    lines.append(f"{name} at {share:.3f} of {command}: {found}")
    return lines


def main() -> int:
    """Run the trials of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="commands that contain this")
    parser.add_argument("--start", action="store_true", help="while Python starts")
    options = parser.parse_args()
    commands = [command for command in COMMANDS if options.only in command]
    found = []
    for command in commands:
        lines = failures([command], options.count, options.seed, own_start=options.start)
        found += lines
        sys.stdout.write(f"{len(lines):4} of {3 * options.count}  {command}\n")
        sys.stdout.writelines(f"      {line.splitlines()[0]}\n" for line in lines)
        sys.stdout.flush()
    kinds = Counter(line.split(": ", 1)[1].split("\n")[0][:60] for line in found)
    sys.stdout.writelines(f"{number:4}  {kind}\n" for kind, number in kinds.most_common())
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
