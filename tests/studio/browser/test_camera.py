"""A camera at 30 frames a second: at least 28 are processed, and none is shown late."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.studio.browser.driver import Driver

pytestmark = pytest.mark.long

LEAST = 28
LATE = 100
"""Milliseconds from the capture of a frame to the first picture after its program is done."""


def fault(report: dict[str, Any]) -> str | None:
    rate = report["processed"] / report["seconds"]
    if rate < LEAST:
        return f"{rate:.1f} frames a second: {report}"
    late = report["latest"]
    return f"a frame was {late:.0f} ms late: {report}" if late > LATE else None


def judge(driver: Driver, flow: str, page: str, folder: Path, program: str) -> None:
    """Judge the best of three runs: one job of the system's own makes a frame late."""
    faults = []
    for _ in range(3):
        found = fault(driver.run(flow, page, folder, program=program))
        if found is None:
            return
        faults.append(found)
    raise AssertionError("\n".join(faults))


def test_the_camera_gives_what_is_asked_of_it(driver: Driver, standin: str, tmp_path: Path) -> None:
    driver.run("standin: has a camera of 30 frames a second", standin, tmp_path)


PROGRAMS = pytest.mark.parametrize("program", ["edges", "trajectory"])


@pytest.mark.parametrize("driver", ["firefox"], indirect=True)
@PROGRAMS
def test_five_seconds(driver: Driver, page: str, program: str, tmp_path: Path) -> None:
    judge(driver, "camera: five seconds", page, tmp_path, program)


@pytest.mark.parametrize("driver", ["chromium"], indirect=True)
@PROGRAMS
def test_a_minute(driver: Driver, page: str, program: str, tmp_path: Path) -> None:
    """One browser will do: a minute of each program in both would be a third of all tests here."""
    judge(driver, "camera: a minute", page, tmp_path, program)
