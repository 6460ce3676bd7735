"""The client of the compiler's worker: who gets which answer, and what is said when it is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.support.page_code import PAGE, Bundles, run

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def found(bundles: Bundles) -> dict[str, Any]:
    """The output of ``client.mjs``."""
    script = Path(__file__).with_name("client.mjs")
    client = bundles.for_node(PAGE / "compiler" / "client.ts")
    answer: dict[str, Any] = json.loads(run(script, client.as_uri()))
    return answer


def test_the_worker_is_told_where_the_page_is(found: dict[str, Any]) -> None:
    assert found["heard"][0]["base"] == "http://page.example/studio/"


def test_bytes_of_the_memory_go_beside_the_request(found: dict[str, Any]) -> None:
    compiled = found["heard"][1]
    assert (compiled["method"], compiled["blobs"]) == ("compile", [[7, 8]])
    (request,) = json.loads(compiled["args"])
    assert request["memory"] == [{"address": 3, "planes": 1, "data": 0}]


def test_answers_find_who_asked_in_any_order(found: dict[str, Any]) -> None:
    assert found["compiled"] == {"program": None, "module": [1, 2, 3]}
    assert found["condition"] == "error: no label 'x'"
    assert found["whole"] == [4, 5]


def test_the_memory_of_a_run_comes_as_bytes(found: dict[str, Any]) -> None:
    assert found["memory"] == [[[3, 1, 255]]]


def test_loading_is_told_and_its_end(found: dict[str, Any]) -> None:
    assert found["loading"][:2] == [{"text": "Loading", "share": 0.5}, None]


def test_a_compiler_that_was_stopped_refuses_what_it_was_asked(found: dict[str, Any]) -> None:
    assert found["stopped"] == ["error: The compiler was stopped", True]


def test_after_a_stop_another_worker_answers(found: dict[str, Any]) -> None:
    assert found["again"] == ["new", 2]


def test_a_worker_that_cannot_load_refuses_all_that_waits(found: dict[str, Any]) -> None:
    assert found["failed"] == ["error: Out of memory"] * 2


def test_a_worker_that_breaks_down_says_why(found: dict[str, Any]) -> None:
    assert found["broken"].startswith("error: ")
    assert found["broken"].endswith(": 404")


def test_a_program_that_python_has_forgotten_is_compiled_again(found: dict[str, Any]) -> None:
    assert found["asked"] == [
        ["condition", ["r3", 0]],
        ["compile", [1, True]],
        ["compile", [0, False]],
        ["condition", ["r3", 0]],
    ]
    assert found["read"] == "read"
