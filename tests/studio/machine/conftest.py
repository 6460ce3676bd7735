"""Chips of the page in processes of their own, shared by the tests of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.page_chip import DRIVER, PageChip, bundle, missing

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(scope="session")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bundled driver; skip where there is no Node, or no package of it."""
    reason = missing()
    if reason:
        pytest.skip(reason)
    return bundle(DRIVER, tmp_path_factory.mktemp("driver"))


@pytest.fixture(scope="module")
def page(driver: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageChip]:
    """A chip of the page."""
    chip = PageChip(driver, tmp_path_factory.mktemp("page"))
    yield chip
    chip.close()


@pytest.fixture(scope="module")
def forgetful(driver: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageChip]:
    """A chip whose snapshots are so near each other, and so few, that small programs meet all."""
    folder = tmp_path_factory.mktemp("forgetful")
    chip = PageChip(driver, folder, {"spacing": 40, "budget": 400_000})
    yield chip
    chip.close()
