"""Chips of the page in processes of their own, shared by the tests of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.page_chip import PageChip

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.support.page_code import Bundles


@pytest.fixture(scope="session")
def driver(bundles: Bundles) -> Path:
    """The bundled driver."""
    return bundles.for_node("machine/chip_driver.ts")


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
