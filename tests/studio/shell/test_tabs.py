"""Two tabs with the studio keep a program each: neither is lost when both are closed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.support.page_code import Bundles, run

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def found(bundles: Bundles) -> Any:
    """The text that is kept after six edits: two in one tab, one in the other, and so on."""
    script = Path(__file__).with_name("tabs.mjs")
    return json.loads(run(script, bundles.for_node("shell/tabs.ts").as_uri()))


def test_the_program_of_each_tab_is_kept(found: Any) -> None:
    assert found["kept"] == "second!!"
    assert "first!!" in found["stored"]


def test_of_each_tab_the_newest_program_is_set_aside(found: Any) -> None:
    assert sorted(found["stored"]) == ["first!!", "second"]


def test_both_tabs_show_what_was_set_aside(found: Any) -> None:
    assert found["asides"] == [found["stored"], found["stored"]]


def test_the_reader_hears_of_another_tab_once(found: Any) -> None:
    assert found["told"] == [None, None, True, True, False, None]
