"""`python -m benchmarks hard`: the bound of programs that are made to take long."""

from __future__ import annotations

import sys

import pytest

from benchmarks.__main__ import main
from benchmarks.hard import beyond, shown_bounds
from benchmarks.programs import long_clip
from benchmarks.ready import hard

main_module = sys.modules[main.__module__]

TABLE = {
    "quick": {"total ms": 40.0, "compiled": 1.0},
    "just": {"total ms": 1_000.0, "compiled": 1.0},
    "late": {"total ms": 1_001.0, "compiled": 1.0},
    "given up": {"total ms": 1_700.0, "compiled": 0.0},
}


def test_a_program_is_in_time_or_the_reference_engine_runs_it() -> None:
    assert beyond(TABLE) == ["late"]
    assert shown_bounds(TABLE).splitlines() == [
        "2 programs are ready within 1,000 ms, and the reference engine runs 1 with a notice",
        "error: 'late' takes longer",
    ]


@pytest.mark.parametrize("late", [False, True])
def test_the_command_fails_if_one_is_late(
    late: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    table = {name: row for name, row in TABLE.items() if late or name != "late"}
    monkeypatch.setattr(main_module, "hard", lambda _: table)
    if not late:
        main(["hard"])
    else:
        with pytest.raises(SystemExit) as end:
            main(["hard"])
        assert end.value.code == 1
    assert ("'late' takes longer" in capsys.readouterr().out) is late


@pytest.mark.long
@pytest.mark.parametrize("compiled", [False, True])
def test_a_notice_tells_that_the_reference_engine_runs_a_program(
    compiled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("benchmarks.ready.PROGRAMS", {"short": "MOV r0, #1\nHALT"})
    if not compiled:
        monkeypatch.setattr("npchip.engines.wasm.host.engine._MOST_TRANSLATIONS", 0)
    (row,) = hard(long_clip()).values()
    assert row["words"] == 2
    assert row["compiled"] == compiled
    assert row["total ms"] > 0
