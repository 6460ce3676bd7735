"""Small sweeps: a folder with programs, a scene, clips and sweep files."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from npchip.host.scenes import Disc, Linear, Object, Scene, render
from npchip.host.scenes.output import write_clip

COUNT = """
.equ STEP, 1
.equ LIMIT, 100
.output total, 0, scalar
        MOV     r0, #0
frame:  EXPOSE
        ADD     r0, #STEP
        OUT     0, r0
        CMP     r0, #LIMIT
        JANY    LO, frame
        RET
"""
"""Counts frames, and traps when it has reached LIMIT."""

SCENE = """
frames: 12
noise: 2
objects:
  - {shape: disc, radius: 5, brightness: 230, start: [20, 20], velocity: [0.7, 1.5]}
"""

SWEEP = """
programs: [trajectory, tracking]
clips: [coin_slide, ball.npy, {scene: scene.yaml, seeds: 1..3}]
machines: [default, {extends: default, sensor: {noise_rms: [0, 4]}}]
define: {THRESHOLD: [24, 40]}
first: 10
"""

ROWS = 2 * 5 * 2 * 2


def folder_for(path: Path, text: str = SWEEP) -> Path:
    """Write all files into a folder, and return that of the sweep."""
    (path / "count.s").write_text(COUNT)
    (path / "scene.yaml").write_text(SCENE)
    ball = Object(shape=Disc(radius=4), motion=Linear(start=(15, 15), velocity=(1, 2)))
    scene = Scene(objects=(ball,), frames=14, seed=3)
    write_clip(path / "ball.npy", *_drawn(scene))
    np.save(path / "dark.npy", np.zeros((6, 64, 80), np.uint8))
    return sweep_file(path, text)


def _drawn(scene: Scene) -> Any:
    clip, truth = render(scene)
    return clip, scene, truth


def sweep_file(path: Path, text: str) -> Path:
    """Write a sweep file."""
    file = path / "s.yaml"
    file.write_text(text)
    return file


def rows(folder: Path) -> list[dict[str, str]]:
    """Return the rows of ``runs.csv``."""
    with (folder / "runs.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def tables(folder: Path) -> dict[str, bytes]:
    """Return the bytes of all that a sweep writes for people."""
    names = ("runs.csv", "runs.parquet", "sweep.json", "frames.parquet")
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def journal(folder: Path) -> list[str]:
    """Return the lines of the journal; none if it is not there yet."""
    file = folder / "journal.jsonl"
    return file.read_text().splitlines() if file.exists() else []


def start(*arguments: str | Path, where: Path, **extra: Any) -> subprocess.Popen[str]:
    """Start ``npchip sweep`` as a process of its own."""
    command = [sys.executable, "-m", "npchip", "sweep", *map(str, arguments)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, cwd=where, text=True, **(pipes | extra))
