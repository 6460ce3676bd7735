"""A pytest plugin: records which functions each test calls, or runs chosen tests in an order.

The environment says which: `RECORD` names a folder, `CHOOSE` a file.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Generator
from pathlib import Path
from types import CodeType, FrameType

import pytest

import npchip

RECORD = "NPCHIP_MUTANTS_RECORD"
CHOOSE = "NPCHIP_MUTANTS_CHOOSE"
PACKAGE = Path(npchip.__file__).parent

_calls: dict[int, CodeType] = {}
_failed: set[str] = set()


def _call(frame: FrameType, _event: str, _arg: object) -> None:
    _calls[id(frame.f_code)] = frame.f_code


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Write a line with the functions that a test calls; those of other processes are not seen."""
    folder = os.environ.get(RECORD)
    if folder is None:
        return (yield)
    _calls.clear()
    begun = time.monotonic()
    threading.settrace(_call)
    sys.settrace(_call)
    try:
        return (yield)
    finally:
        sys.settrace(None)
        threading.settrace(None)
        inside = f"{PACKAGE}{os.sep}"
        functions = sorted(
            f"{Path(code.co_filename).relative_to(PACKAGE).as_posix()}:{code.co_qualname}"
            for code in _calls.values()
            if code.co_filename.startswith(inside)
        )
        seconds = None if item.nodeid in _failed else round(time.monotonic() - begun, 3)
        with (Path(folder) / f"{os.getpid()}.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps([item.nodeid, seconds, functions]) + "\n")


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Remember tests that fail or are skipped: they notice nothing."""
    if not report.passed:
        _failed.add(report.nodeid)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Keep the chosen tests, in their order, behind those that the record does not know."""
    chosen = os.environ.get(CHOOSE)
    if chosen is None:
        return
    order, known = json.loads(Path(chosen).read_text("utf-8"))
    places = {name: place for place, name in enumerate(order)}
    kept = [item for item in items if item.nodeid in places or item.nodeid not in known]
    kept.sort(key=lambda item: places.get(item.nodeid, -1))
    config.hook.pytest_deselected(items=[item for item in items if item not in set(kept)])
    items[:] = kept
