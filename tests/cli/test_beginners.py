"""Questions of a beginner that name no instruction and no file get an answer or a place."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli
from npchip.program.model import OUTPUT_KINDS


def npchip(*arguments: str) -> Result:
    return CliRunner().invoke(cli, arguments, prog_name="npchip")


@pytest.mark.parametrize("command", ["run", "asm"])
def test_a_source_of_this_name_is_nearer_than_a_bundled_program(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("night.s").write_text("        HALT\n")
    result = npchip(command, "night")
    assert result.exit_code == 2
    assert "hint: did you mean night.s?" in result.output


def test_the_kinds_of_output_are_listed() -> None:
    output = npchip("isa", ".output").output
    assert all(kind in output for kind in OUTPUT_KINDS)


def test_a_directive_needs_no_dot() -> None:
    assert npchip("isa", "reg").output == npchip("isa", ".reg").output


@pytest.mark.parametrize("code", ["NP310", "npw06"])
def test_a_code_leads_to_its_document(code: str) -> None:
    result = npchip("isa", code)
    assert result.exit_code == 2
    assert "docs/errors.md" in result.output
