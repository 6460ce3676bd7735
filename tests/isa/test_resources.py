"""Data files are read as resources of the package, which need not lie in a folder."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import npchip

CODE = """\
import npchip.isa, npchip.machine
npchip.isa.load_isa()
print(npchip.machine.load_machine("default").np_rows)
"""


@pytest.mark.long
def test_the_package_works_from_a_zip_file(tmp_path: Path) -> None:
    """Fails before: the instruction set and the machines were read by path."""
    folder = Path(npchip.__file__).parent
    with zipfile.ZipFile(tmp_path / "app.zip", "w") as archive:
        for path in folder.rglob("*"):
            if path.suffix in {".py", ".yaml"}:
                archive.write(path, Path("npchip") / path.relative_to(folder))
    done = subprocess.run(
        [sys.executable, "-c", CODE],
        env={"PYTHONPATH": str(tmp_path / "app.zip")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "8\n"), done.stderr
