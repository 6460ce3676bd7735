"""A camera at 30 frames a second: at least 28 are processed, and none is shown late."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.studio.browser.driver import Driver

pytestmark = pytest.mark.long

LEAST = 28
LATE = 100
"""Milliseconds from taking a frame to the first picture after the program has completed it."""


def judge(report: dict[str, Any]) -> None:
    rate = report["processed"] / report["seconds"]
    assert rate >= LEAST, f"{rate:.1f} frames a second: {report}"
    assert report["latest"] <= LATE, f"a frame was {report['latest']:.0f} ms late: {report}"


PROGRAMS = pytest.mark.parametrize("program", ["edges", "trajectory"])


@pytest.mark.parametrize("driver", ["firefox"], indirect=True)
@PROGRAMS
def test_five_seconds(driver: Driver, page: str, program: str, tmp_path: Path) -> None:
    judge(driver.run("camera: five seconds", page, tmp_path, program=program))


@pytest.mark.parametrize("driver", ["chromium"], indirect=True)
@PROGRAMS
def test_a_minute(driver: Driver, page: str, program: str, tmp_path: Path) -> None:
    """One browser will do: a minute of each program in both would be a third of all tests here."""
    judge(driver.run("camera: a minute", page, tmp_path, program=program))
