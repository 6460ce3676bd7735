"""The command line of ``npchip kernel``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import Chip, assemble
from npchip.cli.main import cli
from tests.kernels.cases import filtered, frames, named

BINOMIAL = "1 2 1; 2 4 2; 1 2 1"
ACROSS = "-1 0 1; -2 0 2; -1 0 1"


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["kernel", *arguments], prog_name="npchip")


def test_the_program_that_it_writes_runs(tmp_path: Path) -> None:
    file = tmp_path / "binomial.s"
    done = invoke(BINOMIAL, "--divide", "16", "--name", "binomial", "-o", str(file))
    assert done.exit_code == 0, done.output
    assert "words" in done.stdout
    clip = frames(3)
    result = Chip(assemble(file)).run(clip)
    assert np.array_equal(result.outputs["binomial"], filtered(named("binomial"), clip))


def test_without_a_file_it_prints_the_program() -> None:
    done = invoke(ACROSS, BINOMIAL, "--name", "edge", "--add", "128", "--add", "0", "--wrap")
    assert done.exit_code == 0, done.output
    assert ".output edge1, 0, picture\n.output edge2, 1, picture" in done.stdout
    assert "sum + 128, modulo 256" in done.stdout


def test_what_it_shares_is_explained() -> None:
    done = invoke("--explain", BINOMIAL, ACROSS)
    assert [line.split()[0] for line in done.stdout.splitlines()[:4]] == [
        "kernel",
        "k1",
        "k2",
        "all",
    ]
    assert "additions for each pixel" in done.stdout
    assert "EXPOSE" not in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["1 2; 3 4"], "expected 3 rows of 3 numbers or 5 rows of 5, found rows of 2, 2 [NP530]"),
        (["1 2 1; 2 4 2; 1 2 x"], "found 'x' [NP530]"),
        (["kernel.txt"], "found 'kernel.txt' [NP530]"),
        (["1 2 1; 2 4 2; 1 2 1.5"], "found '1.5' [NP530]"),
        (["1 2 1; 2 4 2; 1 2 99999"], "found '99999' [NP530]"),
        (["0 0 0; 0 0 0; 0 0 0"], "all weights are 0 [NP530]"),
        ([""], "found rows of 0 [NP530]"),
        ([BINOMIAL, "--name", "1st"], "kernel name '1st'"),
        ([BINOMIAL, "--add", "300"], "expected -255 to 255 [NP530]"),
        ([BINOMIAL, "--divide", "9"], "expected a power of two from 1 to 32768 [NP531]"),
        ([BINOMIAL, "--divide", "-4"], "expected a power of two from 1 to 32768 [NP531]"),
        (["9 9 9; 9 999 9; 9 9 9"], "16 bits do not hold them [NP532]"),
        ([BINOMIAL] * 3 + ["--divide", "2"] * 2, "--divide is given 2 times for 3 kernels [NP534]"),
        ([BINOMIAL] * 2 + ["--name", "a"] * 2, "two kernels are called a [NP534]"),
        ([BINOMIAL] * 17, "expected 1 to 16 kernels, one for each port [NP534]"),
        ([BINOMIAL, "-o", "smooth.txt"], "[NP535]"),
        ([BINOMIAL, "--devide", "2"], "No such option"),
        ([BINOMIAL, "-x"], "No such option"),
    ],
)
def test_bad_input(arguments: list[str], message: str) -> None:
    done = invoke(*arguments)
    assert done.exit_code == 2
    assert message in done.stderr
    assert not done.stdout
