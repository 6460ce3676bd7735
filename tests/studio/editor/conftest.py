"""The page's editor in a process of Node, shared by the tests of a file."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.support.page_code import Answers, Bundles


@pytest.fixture(scope="module")
def harness(bundles: Bundles) -> Iterator[Answers]:
    """The page's editor."""
    with Answers(bundles.for_node("editor/harness.ts")) as page:
        yield page
