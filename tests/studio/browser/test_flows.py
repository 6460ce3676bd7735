"""Flows that need nothing but the page: each file of flows, nearly all in both browsers."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.studio.browser.driver import Driver
from tests.studio.browser.tools import flow_files, flow_names

pytestmark = pytest.mark.long

ALONE = ("run", "write", "editor", "access", "crawl")
"""Files of which every flow is run here; tests of their own hand something to the others."""
GIVEN = {"agreement", "camera", "files", "measure", "offline"}

ONCE = {
    "access: axe, light, on a phone",
    "access: axe, dark",
    "access: sizes at 200 %",
    "crawl: every button, dark",
    "crawl: every button, on a phone",
}
"""Long ones that show what another shows too, but for the style sheet: one browser will do."""

FLOWS = [name for path in flow_files() if path.stem in ALONE for name in flow_names(path)]
CAMERA = [
    "camera: a link never starts it",
    "camera: frames flow",
    "camera: refused, missing or busy, it gets a message and changes nothing",
]


def test_no_file_of_flows_is_forgotten() -> None:
    assert {path.stem for path in flow_files()} == {*ALONE} | GIVEN


@pytest.mark.parametrize("flow", [name for name in FLOWS + CAMERA if name not in ONCE])
def test_flow(driver: Driver, page: str, flow: str, tmp_path: Path) -> None:
    driver.run(flow, page, tmp_path)


@pytest.mark.parametrize("driver", ["chromium"], indirect=True)
@pytest.mark.parametrize("flow", [name for name in FLOWS if name in ONCE])
def test_flow_in_one_browser(driver: Driver, page: str, flow: str, tmp_path: Path) -> None:
    driver.run(flow, page, tmp_path)
