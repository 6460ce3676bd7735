"""``npchip learn`` as a test calls it, and the exercise that most of them take."""

from __future__ import annotations

from typing import TYPE_CHECKING

from npchip.course.exercise import load_course
from tests.support.commands import invoke

if TYPE_CHECKING:
    from click.testing import Result

ALARM = load_course().exercises["alarm"]


def learn(*arguments: str) -> Result:
    result = invoke("learn", *arguments)
    assert "Traceback" not in result.output
    return result
