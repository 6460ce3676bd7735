"""Questions to the page's frames: a process of Node answers, itself or by a browser."""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import Fit, open_frames

HERE = Path(__file__).parent
STUDIO = HERE.parents[2] / "src" / "npchip" / "studio"
MODULES = STUDIO / "node_modules"
BROWSERS = {"chrome": ("chromium", "chromium-browser"), "firefox": ("firefox-esr", "firefox")}
PUPPETEER = MODULES / "puppeteer-core" / "lib" / "puppeteer" / "puppeteer-core.js"
SECONDS = 90
"""Until a question counts as one that hangs."""

Answer = NDArray[np.uint8] | str
"""Frames, or the code of a mistake."""


class Frames:
    """The page's frames in an engine."""

    def __init__(self, process: subprocess.Popen[bytes], kind: str) -> None:
        self._process = process
        self.kind = kind

    def ask(self, what: str, /, **question: Any) -> Any:
        """Return the answer to a question of `probe.ts`."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        line = json.dumps({"ask": what, **question}) + "\n"
        self._process.stdin.write(line.encode())
        self._process.stdin.flush()
        ready, _, _ = select.select([self._process.stdout], [], [], SECONDS)
        assert ready, f"no answer within {SECONDS} s"
        answer = self._process.stdout.readline()
        assert answer, "the engine has ended"
        return json.loads(answer)

    def open(
        self, *paths: Path, size: tuple[int, int] = (64, 80), fit: Fit | None = None
    ) -> dict[str, Any]:
        """Open files; return the answer with the frames as an array, if there are any."""
        files = [
            {"name": path.name, "data": base64.b64encode(path.read_bytes()).decode()}
            for path in paths
        ]
        answer: dict[str, Any] = self.ask("open", files=files, size=size, fit=fit)
        if "data" in answer:
            answer["frames"] = array_of(answer)
        return answer


def array_of(answer: dict[str, Any]) -> NDArray[np.uint8]:
    """Return the frames of an answer."""
    data = np.frombuffer(base64.b64decode(answer["data"]), np.uint8)
    return data.reshape(answer["shape"])


def expected(path: Path, size: tuple[int, int] = (64, 80), fit: Fit | None = None) -> Answer:
    """Return npchip's own frames of a path, or the code of its error."""
    try:
        return np.stack(list(open_frames(path, *size, fit)))
    except InputError as error:
        return error.code


def found(answer: dict[str, Any]) -> Answer:
    """Return the page's frames, or the code of its error."""
    return answer["frames"] if "frames" in answer else str(answer["error"])


def same(one: Answer, other: Answer) -> bool:
    """Tell whether two answers are the same frames, or the same error."""
    if isinstance(one, str) or isinstance(other, str):
        return isinstance(one, str) and isinstance(other, str) and one == other
    return np.array_equal(one, other)


@contextmanager
def engine(kind: str, folder: Path) -> Iterator[Frames]:
    """Start Node, or a browser; skip the test where something is missing."""
    esbuild = MODULES / ".bin" / "esbuild"
    if not esbuild.exists():
        pytest.skip(f"no {esbuild}: the page's packages are not there")
    node = os.environ.get("NPCHIP_NODE") or shutil.which("node")
    if node is None:
        pytest.skip("Node.js is not installed")
    browser = next(filter(None, map(shutil.which, BROWSERS.get(kind, ()))), None)
    if kind != "node" and browser is None:
        pytest.skip(f"{' or '.join(BROWSERS[kind])} is not installed")
    if kind != "node" and not _drives(node):
        pytest.skip("no puppeteer-core, or a Node.js before 22.12")
    probe = folder / "probe.mjs"
    options = ["--bundle", "--format=esm" if kind == "node" else "--format=iife"]
    subprocess.run(
        [esbuild, HERE / "probe.ts", *options, f"--outfile={probe}", "--log-level=warning"],
        check=True,
        env=os.environ | {"NODE_PATH": str(MODULES)},
    )
    process = subprocess.Popen(
        [node, HERE / "ask.mjs", probe, kind, browser or "", PUPPETEER, folder],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    try:
        yield Frames(process, kind)
    finally:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.close()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        process.stdout.close()


def _drives(node: str) -> bool:
    said = subprocess.run([node, "--version"], capture_output=True, text=True, check=True).stdout
    major, minor = (int(part) for part in said.strip().lstrip("v").split(".")[:2])
    return PUPPETEER.exists() and (major, minor) >= (22, 12)
