"""The pytest plugin, in a pytest of its own."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import entry_points

import pytest

# Pytest within pytest forgets the modules that it imports; NumPy and YAML must be there before.
import npchip.testing.report
from npchip.isa import load_isa

assert npchip.testing.report
assert load_isa()

pytest_plugins = ["pytester"]

PROGRAM = """
.output first, 0, scalar
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r0
        JMP     frame
"""
TWO_RUNS = f"""\
; run: dark levels=0 machine=default,conservative
; expect: first == 0
; run: light levels=255,250
; expect: first == 255
{PROGRAM}"""


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    monkeypatch.delenv("CI", raising=False)
    monkeypatch.setenv("PYTEST_ADDOPTS", "-p no:cacheprovider")
    return pytester


def write(pytester: pytest.Pytester, **sources: str) -> None:
    for name, text in sources.items():
        (pytester.path / f"{name}.s").write_text(text, encoding="utf-8")


def test_pytest_finds_the_plugin() -> None:
    (found,) = entry_points(group="pytest11", name="npchip")
    assert found.value == "npchip.pytest_plugin"


def test_every_run_is_an_item_and_a_failure_is_the_difference(run: pytest.Pytester) -> None:
    write(run, test_a=TWO_RUNS, other=TWO_RUNS)
    result = run.runpytest("-v")
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines([
        "test_a.s::dark PASSED*",
        "test_a.s::dark@conservative PASSED*",
        "test_a.s::light FAILED*",
        "test_a.s:4: expected first == 255; found 250 in frame 1",
    ])  # fmt: skip
    assert "Traceback" not in result.stdout.str()
    assert "pytest_plugin.py" not in result.stdout.str()


def test_a_source_is_taken_where_it_is_named(run: pytest.Pytester) -> None:
    write(run, other=TWO_RUNS.replace("== 255", ">= 250"))
    run.runpytest("other.s").assert_outcomes(passed=3)
    run.runpytest("other.s::dark").assert_outcomes(passed=1)
    run.runpytest().assert_outcomes()
    (run.path / "pytest.ini").write_text("[pytest]\nnpchip_files = *.s\n")
    run.runpytest().assert_outcomes(passed=3)


def test_beside_python_tests(run: pytest.Pytester) -> None:
    write(run, test_a=TWO_RUNS)
    (run.path / "test_b.py").write_text("def test_b(): pass\n")
    run.runpytest("-k", "dark or test_b").assert_outcomes(passed=3, deselected=1)


def test_sources_for_another_assembler_are_left_alone(run: pytest.Pytester) -> None:
    """Fails before: a foreign test_*.s was an error, and no test ran."""
    write(run, test_boot="@ GNU assembly\n\t.text\n_start:\tmov r0, #1 ; run it\n")
    (run.path / "test_raw.s").write_bytes(b"\xff\xfe\x00")
    (run.path / "test_b.py").write_text("def test_b(): pass\n")
    run.runpytest().assert_outcomes(passed=1)
    named = run.runpytest("test_boot.s")
    named.assert_outcomes(errors=1)
    named.stdout.fnmatch_lines(["*nothing to check*NP275*"])


def test_goldens_are_recorded_and_compared(run: pytest.Pytester) -> None:
    golden = TWO_RUNS.replace("== 255", ">= 250\n; expect: golden").replace(
        "== 0", "== 0\n; expect: golden"
    )
    write(run, test_a=golden)
    run.runpytest().assert_outcomes(failed=3)
    update = run.runpytest("--npchip-update", "-rP")
    update.assert_outcomes(passed=3)
    update.stdout.fnmatch_lines(["*golden updated: light*"])
    run.runpytest().assert_outcomes(passed=3)
    write(run, test_a=golden.replace("OUT ", "NOP\n OUT "))
    result = run.runpytest()
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(["golden: frame 0*cycles*expected 267*found 268  +1, +0.4 %"])
    write(run, test_a=golden.replace("run: light", "run: bright"))
    run.runpytest().stdout.fnmatch_lines(["*'light' is recorded, but no run of that name expects*"])


def test_no_update_in_ci_or_in_several_processes(
    run: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(run, test_a=TWO_RUNS)
    several = run.runpytest("--npchip-update", "-n", "2")
    several.stderr.fnmatch_lines(["*works in one process: add -n 0"])
    monkeypatch.setenv("CI", "1")
    refused = run.runpytest("--npchip-update")
    assert refused.ret == pytest.ExitCode.USAGE_ERROR
    refused.stderr.fnmatch_lines(["*NP277*"])


def test_what_cannot_be_collected_is_told_without_a_traceback(run: pytest.Pytester) -> None:
    write(
        run, test_a="  HALT\n", test_b="; expect: words = 1\n  HALT\n", test_c="; run: a\n  HALT\n"
    )
    result = run.runpytest("test_a.s", "test_b.s", "test_c.s")
    result.assert_outcomes(errors=3)
    result.stdout.fnmatch_lines([
        "test_a.s: nothing to check*NP275*",
        "test_b.s:1:17: error: *",
        "test_c.s:1:8: error: run 'a' expects nothing*",
    ])  # fmt: skip
    assert "Traceback" not in result.stdout.str()


def test_without_programs_numpy_is_not_imported(run: pytest.Pytester) -> None:
    (run.path / "test_b.py").write_text("def test_b(): pass\n")
    code = (
        "import sys, pytest\n"
        "assert pytest.main(['-q', '-p', 'npchip.pytest_plugin']) == 0\n"
        "loaded = {name.split('.')[0] for name in sys.modules}\n"
        "assert 'npchip' in loaded\n"
        "assert not loaded & {'numpy', 'yaml', 'click', 'PIL'}, loaded\n"
    )
    environment = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
