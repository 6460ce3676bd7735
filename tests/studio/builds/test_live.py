"""The page that ``npchip export digits`` makes reads digits on paper before the camera."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from npchip import bundle
from npchip.cli.main import cli
from npchip.host.vision.networks.network import NONE
from tests.support.page_code import DRIVES, PUPPETEER, browser, here, node, packages, site

SCRIPT = Path(__file__).with_name("live.mjs")
ROWS, COLS, EACH = 480, 640, 20

pytestmark = pytest.mark.long


def film(path: Path) -> Path:
    """Dark digits on paper that is brighter on the left, with noise; then paper alone."""
    digits = np.load(bundle.find("clip", "digits_drawn")).astype(float)
    rng = np.random.default_rng(0)
    paper = 200 - 20 * np.arange(COLS) / COLS
    with path.open("wb") as file:
        file.write(f"YUV4MPEG2 W{COLS} H{ROWS} F30:1 Ip A1:1 C420jpeg\n".encode())
        for digit in (*digits, np.zeros_like(digits[0])):
            ink = np.kron(digit, np.ones((8, 8)))[16:-16]
            grey = paper - 0.6 * ink + rng.normal(0, 3, (ROWS, COLS))
            luma = grey.clip(16, 235).astype(np.uint8).tobytes()
            file.write((b"FRAME\n" + luma + b"\x80" * (ROWS * COLS // 2)) * EACH)
    return path


def test_digits_on_paper_are_read_and_paper_alone_is_not(tmp_path: Path) -> None:
    here(site)
    here(packages)
    opener, engine = here(lambda: browser("chromium")), here(lambda: node(DRIVES))
    page = tmp_path / "digits.html"
    options = ["--define", "DARK=1", "--define", "SURE=200", "--guide", "56x48"]
    done = CliRunner().invoke(cli, ["export", "digits", "-o", str(page), *options])
    assert done.exit_code == 0, done.output
    arguments = [PUPPETEER.resolve().as_uri(), page.as_uri(), str(film(tmp_path / "film.y4m"))]
    command = [str(engine), str(SCRIPT), str(opener), *arguments]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert ended.returncode == 0, ended.stderr
    found = json.loads(ended.stdout)
    assert found["complaints"] == []
    assert found["answers"] == [*range(10), NONE]
    guide = found["guide"]
    assert guide["right"] - guide["left"] == pytest.approx(48 / 80, abs=0.02)
    assert guide["bottom"] - guide["top"] == pytest.approx(56 / 64, abs=0.02)
