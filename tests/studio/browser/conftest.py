"""A browser of each kind for all tests of a process, and the page for them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.studio.browser import tools
from tests.studio.browser.driver import Driver
from tests.studio.browser.servers import serve_folder, serve_site
from tests.support.page_code import DRIVES, KINDS, browser, here, node, site


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
    driver = Driver(kind, here(lambda: browser(kind)), here(lambda: node(DRIVES)), script, camera)
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
    with serve_site(here(site)) as url:
        yield url
