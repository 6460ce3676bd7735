"""The archive of the compiler's Python, as the page unpacks it."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from npchip.studio.python_files import write_python_zip
from npchip.studio.toolchain.facade import Toolchain
from tests.studio.compiler.calls import call

pytestmark = pytest.mark.long


def test_the_archive(tmp_path: Path) -> None:
    """The archive runs by itself, and packing twice gives the same bytes."""
    archive, again = tmp_path / "npchip.zip", tmp_path / "again.zip"
    write_python_zip(archive)
    write_python_zip(again)
    assert archive.read_bytes() == again.read_bytes()
    assert archive.stat().st_size < 400_000
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path / "unpacked")
    assert not (tmp_path / "unpacked" / "npchip" / "cli").exists()
    code = (
        f"import sys; sys.path[:0] = [{str(tmp_path / 'unpacked')!r}]\n"
        "import json\n"
        "from npchip.studio.toolchain import page\n"
        "print(page.__file__)\n"
        "print(len(json.loads(page.call('language', '[]')[0])['value']['entries']))\n"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=False
    )
    file, count = done.stdout.split()
    assert file.startswith(str(tmp_path))
    assert int(count) == len(call(Toolchain(tmp_path / "project"), "language")["entries"])
