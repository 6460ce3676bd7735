"""The command line as tests call it, in their own process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from click.testing import CliRunner, Result

from npchip.cli.main import cli

if TYPE_CHECKING:
    from pathlib import Path


def invoke(*arguments: str | Path) -> Result:
    """Run ``npchip`` with these arguments, and return its output and exit code."""
    return CliRunner().invoke(cli, [str(each) for each in arguments], prog_name="npchip")
