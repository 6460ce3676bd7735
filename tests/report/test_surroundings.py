"""Charts are drawn into files whatever a user's Matplotlib settings say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def test_a_notebooks_backend_and_latex_are_not_needed(tmp_path: Path) -> None:
    """Fails before: an internal error, exit code 70."""
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\n")
    (tmp_path / "p.s").write_text("  HALT\n")
    done = subprocess.run(
        [sys.executable, "-m", "npchip", "profile", "p.s", "--plot", "p.svg"],
        env=os.environ | {"MPLBACKEND": "module://no_such_backend"},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "p.svg").read_text().startswith("<?xml")
