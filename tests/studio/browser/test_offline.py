"""The page works without the server that it came from."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.studio.browser.driver import Driver
from tests.studio.browser.servers import studio_process
from tests.support.page_code import here, site

pytestmark = pytest.mark.long


def test_page_without_server(driver: Driver, tmp_path: Path) -> None:
    here(site)
    flow = "offline: the page goes on and opens again without its server"
    with studio_process() as (url, process):
        driver.run(flow, url, tmp_path, server=process)
