"""A browser of each kind for all tests of a process, and the page for them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

import pytest

from tests.studio.browser import tools
from tests.studio.browser.driver import Driver
from tests.studio.browser.servers import serve_folder, serve_site

KINDS = ("chromium", "firefox")

_T = TypeVar("_T")


def here(find: Callable[[], _T]) -> _T:
    """Return what the tests need; skip without it, or fail where nothing may be missing.

    That is where ``CI`` is set: ``tests/conftest.py`` takes it away and leaves ``NPCHIP_CI``.
    """
    try:
        return find()
    except tools.MissingError as error:
        if os.environ.get("NPCHIP_CI"):
            pytest.fail(f"{error}, and with CI set no test of the page is skipped")
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the flows, bundled for Node."""
    return here(lambda: tools.bundled(tmp_path_factory.mktemp("flows")))


@pytest.fixture(scope="session")
def camera(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the film that Chromium's camera shows."""
    return tools.film(tmp_path_factory.mktemp("camera") / "disc.y4m")


@pytest.fixture(scope="session", params=KINDS)
def driver(request: pytest.FixtureRequest, script: Path, camera: Path) -> Iterator[Driver]:
    """Give a browser that runs flows."""
    kind: str = request.param
    driver = Driver(kind, here(lambda: tools.browser(kind)), here(tools.node), script, camera)
    yield driver
    driver.close()


@pytest.fixture(scope="session")
def standin() -> Iterator[str]:
    """Serve the stand-in page and give its address."""
    with serve_folder(tools.HERE / "standin") as url:
        yield url


@pytest.fixture(scope="session")
def page() -> Iterator[str]:
    """Serve the built page as ``npchip studio`` does, and give its address.

    With ``NPCHIP_STUDIO_URL`` set, that of a page which is being worked on.
    """
    if working := os.environ.get("NPCHIP_STUDIO_URL"):
        yield working
        return
    with serve_site(here(tools.site)) as url:
        yield url
