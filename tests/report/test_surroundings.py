"""Charts are drawn into files whatever a user's Matplotlib settings say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
RIG = ROOT / "examples" / "rigs" / "chip.yaml"

DRAWING = {
    "profile": ("profile", "p.s", "--plot", "p.svg"),
    "compare": ("compare", "p.s", "q.s", "--frames", "clip.npy", "--chart", "p.svg"),
    "fuse": ("fuse", "clip.npy", "clip.npy", "--rig", str(RIG), "--plot", "p.png"),
    "orient": ("orient", "plot", "--figure", "3.14", "-o", "p"),
    "run": ("run", "q.s", "--frames", "clip.npy", "--render", "p.png"),
    "scene": (*("scene", "--shape", "disc", "--radius", "5", "--start", "20,20"), "-o", "p.gif"),
}

SURROUNDINGS = {
    "notebook": ("", {"MPLBACKEND": "module://no_such_backend"}),
    "window": ("backend: TkAgg\n", {"MPLBACKEND": "TkAgg"}),
    "latex": ("text.usetex: True\nsavefig.format: pgf\n", {"MPLBACKEND": "pgf"}),
    "odd": ("backend: 3\nfigure.dpi: x\nno.such: 1\naxes.prop_cycle: (\n", {}),
}


def run(command: str, folder: Path, surroundings: str) -> subprocess.CompletedProcess[str]:
    """Run a command that draws into a file called p."""
    settings, variables = SURROUNDINGS[surroundings]
    (folder / "matplotlibrc").write_text(settings)
    (folder / "p.s").write_text("  HALT\n")
    (folder / "q.s").write_text(
        ".output a, 0, plane\nf: EXPOSE\n SAMPLE signal, 0\n OUT 0, r1\n JMP f\n"
    )
    np.save(folder / "clip.npy", np.full((1, 64, 80), 9, np.uint8))
    return subprocess.run(
        [sys.executable, "-m", "npchip", *DRAWING[command]],
        env=os.environ | variables,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.long
@pytest.mark.parametrize("surroundings", SURROUNDINGS)
@pytest.mark.parametrize("command", DRAWING)
def test_every_command_draws_whatever_the_surroundings_say(
    command: str, surroundings: str, tmp_path: Path
) -> None:
    """Fails before: an internal error, exit code 70."""
    done = run(command, tmp_path, surroundings)
    assert done.returncode == 0, done.stderr
    (file,) = (
        p
        for p in tmp_path.rglob("*")
        if p.name in {"p.svg", "p.png", "p.gif"} or "figure" in p.name
    )
    if file.suffix == ".svg":
        assert file.read_text().startswith("<?xml")
    else:
        with Image.open(file) as picture:
            assert min(picture.size) > 50


@pytest.mark.long
def test_a_notebooks_backend_and_latex_are_not_needed(tmp_path: Path) -> None:
    """Fails before: an internal error, exit code 70."""
    SURROUNDINGS["both"] = (SURROUNDINGS["latex"][0], SURROUNDINGS["notebook"][1])
    done = run("profile", tmp_path, "both")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "p.svg").read_text().startswith("<?xml")


@pytest.mark.long
@pytest.mark.parametrize("command", ["profile", "compare", "fuse", "orient"])
def test_settings_of_matplotlib_that_are_no_text_are_named(command: str, tmp_path: Path) -> None:
    """Fails before: an internal error, exit code 70."""
    run(command, tmp_path, "notebook")
    (tmp_path / "matplotlibrc").write_bytes(b"font.family: \xff\n")
    done = subprocess.run(
        [sys.executable, "-m", "npchip", *DRAWING[command]],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2, done.stderr
    assert "matplotlibrc" in done.stderr
