"""The client of the compiler's worker: who gets which answer, and what is said when it is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.support.page_code import PAGE, Bundles, run

pytestmark = pytest.mark.long


def test_client(bundles: Bundles) -> None:
    script = Path(__file__).with_name("client.mjs")
    client = bundles.for_node(PAGE / "compiler" / "client.ts")
    found: dict[str, Any] = json.loads(run(script, client.as_uri()))
    begin, compiled, *_ = found["heard"]
    assert begin["base"] == "http://page.example/studio/"
    assert (compiled["method"], compiled["blobs"]) == ("compile", [[7, 8]])
    (request,) = json.loads(compiled["args"])
    assert request["memory"] == [{"address": 3, "planes": 1, "data": 0}]
    assert found["compiled"] == {"program": None, "module": [1, 2, 3]}
    assert found["whole"] == [4, 5]
    assert found["condition"] == "error: no label 'x'"
    assert found["memory"] == [[[3, 1, 255]]]
    assert found["loading"][:2] == [{"text": "Loading", "share": 0.5}, None]
    assert found["stopped"] == ["error: The compiler was stopped", True]
    assert found["again"] == ["new", 2]
    assert found["failed"] == ["error: Out of memory"] * 2
    assert found["broken"] == "error: The compiler broke down: 404"
    assert "load the page again" in found["once"]
