"""The service worker: what it keeps, what it answers, and how a new version takes its place."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from npchip.studio.bundling import Bundler
from npchip.studio.node import find_node
from tests.support.page_code import here, node, packages, run

HARNESS = Path(__file__).with_name("offline.mjs")
WORKER = "page/offline/service-worker.ts"
BOTH = {"clips/coin slide.npy": "clip"}
FIRST = BOTH | {"index.html": "page 1", "studio.js": "script 1", "chunks/old.js": "part 1"}
SECOND = BOTH | {"index.html": "page 2", "studio.js": "script 2"}

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Actions of two versions of the worker."""
    folder = tmp_path_factory.mktemp("offline")
    here(packages)
    here(node)
    bundler = Bundler(find_node(), folder)
    scripts = []
    for name, files in (("first.js", FIRST), ("second.js", SECOND)):
        digests = {path: hashlib.sha256(text.encode()).hexdigest() for path, text in files.items()}
        bundler.script(folder / name, WORKER, FILES=digests)
        scripts.append(str(folder / name))
    return json.loads(run(HARNESS, *scripts))


def test_all_files_are_kept_in_a_cache_of_its_folder(found: Any) -> None:
    assert (found["install"], found["activate"]) == ("done", "done")
    assert found["fetched"] == sorted(FIRST)
    assert found["caches"] == ["npchip studio /course/studio/"]


def test_a_redirected_page_is_kept_so_that_it_can_open(found: Any) -> None:
    assert found["redirected"] is False


def test_the_page_opens_without_a_network(found: Any) -> None:
    assert found["opened"] == {
        "folder": "page 1",
        "link": "page 1",
        "script": "script 1",
        "spaces": "clip",
    }
    assert found["asked"] == []


def test_what_is_not_of_the_page_is_left_to_the_browser(found: Any) -> None:
    assert found["left"] == {"unknown": None, "outside": None, "posted": None}


def test_files_of_two_versions_are_not_mixed(found: Any) -> None:
    assert found["mixed"] == "studio.js: the server has another version of it"
    assert found["meanwhile"] == "script 1"


def test_an_update_fetches_what_has_changed_past_a_stale_proxy(found: Any) -> None:
    assert found["update"] == "done"
    # The page was fetched by the attempt before; the script is asked for again, past the proxy.
    assert found["refetched"] == ["studio.js", "studio.js"]
    assert found["after"] == "script 2"


def test_the_old_version_is_dropped(found: Any) -> None:
    assert found["kept"] == [len(SECOND)]


def test_tabs_that_are_open_keep_their_version_until_they_go(found: Any) -> None:
    both = len(FIRST) + len(SECOND) - len(BOTH)
    assert found["tab"] == {
        "script": "script 1",
        "worker": "script 1",
        "anew": "script 1",
        "reload": "page 2",
        "part": "part 1",
        "other": "script 2",
        "unknown": None,
        "kept": [both],
        "left": [len(SECOND)],
    }
