"""Help of the command line, and the table of commands."""

from __future__ import annotations

import re
import subprocess
import sys
from typing import Any

import click
import pytest

from npchip.cli.main import COMMANDS, cli
from tests.support.commands import invoke

NPCHIP = [sys.executable, "-m", "npchip"]


def npchip(*arguments: str, **extra: Any) -> subprocess.CompletedProcess[str]:
    command = [*NPCHIP, *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, check=False, **({"timeout": 60} | extra)
    )


def test_help_fits_one_screen_and_names_every_command() -> None:
    for flag in ("--help", "-h"):
        result = invoke(flag)
        assert result.exit_code == 0
        lines = result.output.splitlines()
        assert len(lines) <= 24
        assert max(map(len, lines)) <= 80
        assert all(
            re.search(rf"^  .{{7}}  (\w+, )?{name}[, ]", result.output, re.MULTILINE)
            for name in COMMANDS
        )


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; sys.argv = ['npchip', '--help']\n"
        "from npchip.cli.main import main\n"
        "try: main()\n"
        "finally: print(sorted({'numpy', 'rich', 'PIL', 'yaml'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_run_help_teaches_by_examples() -> None:
    result = invoke("run", "-h")
    assert result.exit_code == 0
    assert result.output.count("  npchip run ") >= 3
    assert max(map(len, result.output.splitlines())) <= 80


def every_help() -> dict[str, str]:
    found = {}
    for name in COMMANDS:
        command = cli.get_command(click.Context(cli), name)
        for below in ((), *((each,) for each in getattr(command, "commands", {}))):
            found[" ".join((name, *below))] = invoke(name, *below, "--help").output
    return found


def test_help_names_no_file_of_a_clone() -> None:
    for name, text in every_help().items():
        assert not re.search(r"\b(asm|examples|docs|src)/", text), name


def test_help_does_not_need_docstrings() -> None:
    code = (
        "from click.testing import CliRunner\n"
        "from npchip.cli.main import cli, with_help\n"
        "with_help(cli)\n"
        "for name in ('', 'run', 'orient predict'):\n"
        "    print(CliRunner().invoke(cli, [*name.split(), '--help']).output)"
    )
    done = subprocess.run(
        [sys.executable, "-OO", "-c", code], capture_output=True, text=True, check=True
    )
    for text in (
        "Try: npchip run trajectory",
        "npchip run trajectory --frames coin_slide",
        "With the camera's yaw and pitch",
    ):
        assert text in done.stdout


def test_version() -> None:
    result = invoke("--version")
    assert re.fullmatch(r"npchip \d+\.\d+\.\d+\n", result.output)


@pytest.mark.parametrize("name", COMMANDS)
def test_table_of_commands_leads_to_modules(name: str) -> None:
    assert isinstance(cli.get_command(click.Context(cli), name), click.Command)
