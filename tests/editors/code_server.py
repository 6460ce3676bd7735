"""VS Code in a browser: code-server with the extension, on a free port."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tests.support.page_code import MissingError

ROOT: Final = Path(__file__).parents[2]
_OWN: Final = ROOT / ".code-server" / "code-server"
"""The place where `.ci/code-server` puts it."""
_SECONDS: Final = 60
"""Patience with a server that does not start."""
SETTINGS: Final = {
    "security.workspace.trust.enabled": False,
    "workbench.startupEditor": "none",
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "chat.disableAIFeatures": True,
    "telemetry.telemetryLevel": "off",
    "extensions.ignoreRecommendations": True,
}


def find() -> Path:
    """Return code-server: the one that ``NPCHIP_CODE_SERVER`` names, or that is installed.

    Raises:
        MissingError: there is none.
    """
    named = os.environ.get("NPCHIP_CODE_SERVER") or shutil.which("code-server")
    found = Path(named) if named else _OWN
    if not found.exists():
        message = "code-server is not installed: bash .ci/code-server does, or name one with"
        raise MissingError(f"{message} NPCHIP_CODE_SERVER")
    return found


@contextmanager
def served(command: Path, extension: Path, folder: Path) -> Iterator[str]:
    """Serve VS Code with an extension, and give its address.

    Args:
        command: code-server.
        extension: the ``.vsix``.
        folder: for all that it keeps.
    """
    home, data = folder / "home", folder / "data"
    for kind, settings in (
        ("User", SETTINGS),
        # What names a program of this computer is no setting of the one before the browser.
        ("Machine", {"npchip.command": [sys.executable, "-m", "npchip"]}),
    ):
        (data / kind).mkdir(parents=True)
        (data / kind / "settings.json").write_text(json.dumps(settings))
    home.mkdir()
    kinds = ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME")
    surroundings = os.environ | dict.fromkeys(kinds, str(home))
    options: list[str | Path] = [
        *("--user-data-dir", data),
        *("--extensions-dir", folder / "extensions"),
        *("--config", folder / "config.yaml"),
    ]
    subprocess.run(
        [command, *options, "--install-extension", extension],
        env=surroundings,
        check=True,
        timeout=_SECONDS,
        stdout=subprocess.DEVNULL,
    )
    options += ["--auth", "none", "--bind-addr", "127.0.0.1:0"]
    process = subprocess.Popen(
        [command, *options, "--disable-telemetry", "--disable-update-check"],
        env=surroundings,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
        yield _address(process)
    finally:
        os.killpg(process.pid, signal.SIGTERM)
        try:
            process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()


def _address(process: subprocess.Popen[str]) -> str:
    """Return the address that a server says it listens on."""
    assert process.stdout is not None
    patience = threading.Timer(_SECONDS, process.kill)
    patience.start()
    said = ""
    for line in process.stdout:
        said += line
        if found := re.search(r"listening on (http://127\.0\.0\.1:\d+)", line):
            patience.cancel()
            return found[1] + "/"
    patience.cancel()
    raise AssertionError(f"code-server has ended:\n{said}")
