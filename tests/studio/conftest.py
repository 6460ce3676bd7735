"""The page's code as scripts, each bundled once in a process."""

from __future__ import annotations

import pytest

from tests.support.page_code import Bundles


@pytest.fixture(scope="session")
def bundles(tmp_path_factory: pytest.TempPathFactory) -> Bundles:
    """Scripts of the page's code."""
    return Bundles(tmp_path_factory.mktemp("bundles"))
