"""Pages of ``npchip export``, opened from disk in real browsers."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from npchip import bundle
from npchip.cli.main import cli
from tests.support.page_code import (
    DRIVES,
    KINDS,
    MODULES,
    PUPPETEER,
    browser,
    here,
    node,
    packages,
    site,
)

SCRIPT = Path(__file__).with_name("open.mjs")

TITLE = "A <coin> & more"

pytestmark = pytest.mark.long


def npchip(*arguments: object) -> str:
    done = CliRunner().invoke(cli, [str(item) for item in arguments])
    assert done.exit_code == 0, done.output
    return done.stdout


@pytest.fixture(scope="module", params=KINDS)
def found(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Findings of a browser in a page of `trajectory`, and then with another clip."""
    kind: str = request.param
    here(site)
    here(packages)
    opener, engine = here(lambda: browser(kind)), here(lambda: node(DRIVES))
    folder = tmp_path_factory.mktemp("player")
    page, own = folder / "page.html", folder / "own.npy"
    npchip("export", "trajectory", "-o", page, "--frames", "coin_slide", "--title", TITLE)
    np.save(own, np.load(bundle.find("clip", "ball_fall_30000fps")))
    axe = MODULES / "axe-core" / "axe.min.js"
    files = [str(axe), page.as_uri(), str(own)]
    command = [str(engine), str(SCRIPT), kind, str(opener), PUPPETEER.resolve().as_uri(), *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    shutil.rmtree(folder)
    return json.loads(done.stdout)


def frames(program: str, clip: str) -> Any:
    return json.loads(npchip("run", program, "--frames", clip, "--json"))["frames"]


def test_its_frames_are_those_of_run(found: Any) -> None:
    wanted = frames("trajectory", "coin_slide")
    assert found["whole"]["frames"] == wanted
    assert found["again"]["frames"] == wanted
    assert found["own"]["frames"] == frames("trajectory", "ball_fall_30000fps")


def test_it_names_itself(found: Any) -> None:
    assert found["title"] == found["heading"] == TITLE


def test_a_step_back_shows_the_instruction(found: Any) -> None:
    assert found["where"].startswith("Next: ")
    assert ".s, line " in found["where"]


def test_it_asks_nobody_and_breaks_no_rule(found: Any) -> None:
    assert set(found["requests"]) <= {"file", "blob", "data"}
    assert found["complaints"] == []


def test_without_a_camera_it_says_so_and_loses_nothing(found: Any) -> None:
    assert found["refused"].count(". ") == 1  # what is wrong, and what would mend it
    assert found["kept"] == found["own"]


def test_everyone_can_use_it_wide_and_on_a_phone_in_both_themes(found: Any) -> None:
    assert found["violations"] == []
