"""Tools for the tests of the page: the flows as one script, a camera's film."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from tests.support.page_code import PUPPETEER, esbuild

HERE = Path(__file__).parent

_FLOW = re.compile(r"^flow\(\s*\"([^\"]+)\"", re.MULTILINE)


def bundled(folder: Path) -> Path:
    """Bundle the driver and all flows to one script for Node, and return it.

    ``puppeteer-core`` is found from beside the page's packages, so the script looks for it there.

    Raises:
        MissingError: the page's packages are not there.
    """
    script = folder / "flows.mjs"
    parts = ["driver/standin", *(f"flows/{path.stem}" for path in flow_files()), "driver/runner"]
    options = (
        *("--format=esm", "--platform=node", "--target=node22", "--sourcemap=inline"),
        *("--loader=ts", f"--tsconfig={HERE / 'tsconfig.json'}", "--external:file:*"),
        f"--alias:puppeteer-core={PUPPETEER.resolve().as_uri()}",
    )
    return esbuild("\n".join(f'import "./browser/{part}";' for part in parts), script, *options)


def flow_files() -> list[Path]:
    """Return the files that hold flows."""
    return sorted((HERE / "flows").glob("*.ts"))


def flow_names(path: Path) -> list[str]:
    """Return the names of the flows in a file, in its order."""
    return _FLOW.findall(path.read_text(encoding="utf-8"))


def film(path: Path, frames: int = 60) -> Path:
    """Write a film for Chromium's camera at 30 frames a second: a bright disc on a dark ground.

    The number of the frame stands in the top row as eight bright or dark squares, so that a flow
    can tell one frame from the next.
    """
    rows, cols = 480, 640
    y, x = np.mgrid[:rows, :cols]
    with path.open("wb") as file:
        file.write(f"YUV4MPEG2 W{cols} H{rows} F30:1 Ip A1:1 C420jpeg\n".encode())
        for number in range(frames):
            center = 80 + 480 * number / frames
            luma = np.where((y - 260) ** 2 + (x - center) ** 2 < 60**2, 220, 40).astype(np.uint8)
            for bit in range(8):
                luma[:40, 80 * bit : 80 * bit + 80] = 220 if number >> bit & 1 else 40
            file.write(b"FRAME\n" + luma.tobytes() + b"\x80" * (rows * cols // 2))
    return path
