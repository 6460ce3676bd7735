"""Three profiles of the tests, and what a run says at its end.

- quick (``pytest``): all tests but those marked ``long``.
- long (``pytest -m long``): the other tests: the rest of the random searches, programs that take
  long, experiments and figures.
- thorough (``NPCHIP_PROFILE=thorough pytest``): all tests, with as many random cases as take hours,
  and those marked ``thorough``: whole pages that take a minute or more to measure again.

The quick profile takes at most `LIMIT` seconds on two quiet cores; the last line of a run tells how
long it took. A test that takes more than a second is marked ``long``, or is one of few.
``.ci/run`` runs quick and long.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import settings

from tests.support import process
from tests.support.profiles import THOROUGH

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

LIMIT = 150
"""Seconds that the quick profile may take on two quiet cores, as README.md promises."""

QUICK = "not long"
"""The selection of marks in pyproject.toml."""

EXTRAS = (
    *("av", "dap", "distributed", "joblib", "lsprotocol", "matplotlib", "pandas", "pyarrow"),
    *("pygls", "scipy", "textual", "vcd", "vcdvcd", "xarray"),
)
"""Libraries of the extras. Tests that import one which is not installed are skipped."""

_BEGIN = pytest.StashKey[float]()
_ALL = pytest.StashKey[bool]()
_FOUND = pytest.StashKey[dict[str, Any]]()

settings.register_profile("quick", deadline=None, max_examples=60)
settings.register_profile("thorough", deadline=None, max_examples=10_000)
settings.load_profile("thorough" if THOROUGH else "quick")


def pytest_configure(config: pytest.Config) -> None:
    """Select all tests where the profile is thorough or one is named; make surroundings plain."""
    config.stash[_BEGIN] = time.monotonic()
    config.stash[_ALL] = THOROUGH or any("::" in argument for argument in config.args)
    if config.option.markexpr == QUICK and config.stash[_ALL]:
        config.option.markexpr = ""
    # As shells have it in the background, and nohup; commands that tests start inherit it.
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
    # Goldens are not updated where it is set; tests of the page skip nothing where it was.
    if ci := os.environ.pop("CI", None):
        os.environ["NPCHIP_CI"] = ci
    if sys.dont_write_bytecode:
        _keep_bytecode(config.rootpath / ".pytest_cache" / "bytecode")


def _keep_bytecode(folder: Path) -> None:
    """Keep compiled modules in a folder, for this process and those that it starts.

    To rewrite the assertions of all tests takes longer than to collect them.
    """
    sys.dont_write_bytecode = False
    sys.pycache_prefix = os.environ["PYTHONPYCACHEPREFIX"] = str(folder)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave tests marked ``thorough`` to their profile, or to who names them."""
    if config.stash[_ALL]:
        return
    left = [item for item in items if item.get_closest_marker("thorough")]
    if left:
        items[:] = [item for item in items if item not in left]
        config.hook.pytest_deselected(items=left)


class _Module(pytest.Module):
    """A file of tests that is skipped if it imports an extra that is missing."""

    def _getobj(self) -> Any:
        try:
            return super()._getobj()  # type: ignore[no-untyped-call]
        except self.CollectError as error:
            _skip_without_extra(error.__cause__)
            raise


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module:
    """Let files of tests be skipped."""
    module: pytest.Module = _Module.from_parent(parent, path=module_path)
    return module


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Note how a test finds its process."""
    item.stash[_FOUND] = process.state()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item) -> Generator[None]:
    """Let a test fail that leaves its process in another state, for others would fail instead."""
    yield
    if changes := process.changes(item.stash[_FOUND]):
        pytest.fail("the test spoils its process: " + "; ".join(changes), pytrace=False)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Generator[None]:
    """Let a test be skipped."""
    try:
        yield
    except ModuleNotFoundError as error:
        _skip_without_extra(error)
        raise


def _skip_without_extra(error: BaseException | None) -> None:
    name = error.name if isinstance(error, ModuleNotFoundError) and error.name else ""
    if name.partition(".")[0] in EXTRAS:
        pytest.skip(f"{name} is not installed", allow_module_level=True)


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Tell how long the run took, and how many tests were skipped."""
    if config.option.collectonly:
        return
    skipped = len(terminalreporter.stats.get("skipped", ()))
    took = f"{time.monotonic() - config.stash[_BEGIN]:.0f} s"
    if config.option.markexpr == QUICK:
        took += f" (the quick profile: at most {LIMIT} s on two quiet cores)"
    terminalreporter.write_line(f"took {took}, {skipped} skipped")
