"""The driver sees what it should, shown on a stand-in page."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.studio.browser.driver import Driver

pytestmark = pytest.mark.long

GOOD = [
    "standin: reads and presses",
    "standin: sees the camera",
    "standin: takes files",
    "standin: saves",
    "standin: prefers dark and still",
    "standin: fits everyone",
]
BAD = {
    "standin: has little contrast": "color-contrast",
    "standin: has a small button and is too wide": "'Run' is .* × 20.0.*is 20.. wide in 1280",
    "standin: hides the focus": "the focus cannot be seen",
    "standin: has no such button": "the page has no button 'Fly'",
    "standin: logs an error": "on purpose",
    "standin: throws": "uncaught: .*on purpose",
    "standin: has a worker that throws": "on purpose",
    "standin: asks another host": "asked another host: http://other.example/",
    "standin: breaks the policy": "policy: img-src http://third.example",
    "standin: never ends": "was not done within 1 s",
    "standin: is not there": "there is no such flow",
}


@pytest.mark.parametrize("flow", GOOD)
def test_good_flows(driver: Driver, standin: str, flow: str, tmp_path: Path) -> None:
    paths = [tmp_path / "a.txt", tmp_path / "b.txt"]
    for path, text in zip(paths, ("first", "second"), strict=True):
        path.write_text(text, encoding="utf-8")
    driver.run(flow, standin, tmp_path, paths=[str(path) for path in paths])


@pytest.mark.parametrize("flow", BAD)
def test_flows_that_fail(driver: Driver, standin: str, flow: str, tmp_path: Path) -> None:
    answer = driver.answer(flow, standin, tmp_path)
    assert not answer["ok"]
    with pytest.raises(AssertionError, match=BAD[flow]):
        raise AssertionError(answer["error"])
    if "such flow" not in BAD[flow]:
        left = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
        assert {*left} >= {"error.txt", "console.txt"}
        assert left.get("page.png", 0) > 1000
