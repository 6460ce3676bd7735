"""The one argument of the modules that write figures and pages: where to write."""

from __future__ import annotations

import argparse
from pathlib import Path


def asked(default: Path) -> Path:
    """Return the path that the command line names, or `default`; ``--help`` says so and ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument(
        "target",
        nargs="?",
        type=Path,
        default=default,
        help=f"where to write (else {default.name})",
    )
    path: Path = parser.parse_args().target
    return path
