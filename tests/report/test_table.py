"""The table of a run, for pipes and for terminals."""

from __future__ import annotations

import re

import numpy as np
import pytest

from npchip.report.table import Clock, plain_text
from npchip.report.terminal import terminal_text
from npchip.run.result import FrameRecord
from tests.support.results import imaged, made, tracked

CLOCK = Clock(10_000_000, stated=False)


def data(text: str) -> list[list[str]]:
    return [line.split() for line in text.splitlines() if not line.startswith("#")]


def without_colors(text: str) -> str:
    return re.sub(r"\x1b\[[\d;]*m", "", text)


def test_plain_table_is_complete_and_has_no_colors() -> None:
    clip = np.zeros((300, 64, 80), np.uint8)
    clip[7, 3, 5] = 255
    text = plain_text(tracked(clip), CLOCK)
    header, *rows = data(text)
    assert header == [
        "frame",
        "valid",
        "center_row",
        "center_col",
        "predicted_row",
        "predicted_col",
        "cycles",
    ]
    assert len(rows) == 300
    assert rows[7] == ["7", "1", "3", "5", "3", "5", "1907"]
    assert "\x1b" not in text


def test_plain_table_is_not_cut_at_80_columns() -> None:
    outputs = {f"a_rather_long_name_{k}": np.zeros(1, np.int32) for k in range(12)}
    header = data(plain_text(made(outputs, [1]), CLOCK))[0]
    assert header == ["frame", *outputs, "cycles"]


def test_kinds_of_cells() -> None:
    outputs = {
        "few": [[1, 2], None],
        "none": [[], []],
        "many": [list(range(20)), [1]],
        "picture": np.zeros((2, 64, 80), np.uint8),
    }
    result = made(outputs, [1, 2])
    rows = data(plain_text(result, CLOCK))
    assert rows[1] == ["0", "1,2", "none", ",".join(map(str, range(20))), "64x80", "1"]
    assert rows[2][1] == "-"
    assert "0,1,2,3,4,5,6,7,... (20)" in without_colors(terminal_text(result, CLOCK, 120))
    assert "picture: --save DIR" in plain_text(result, CLOCK)


def test_summary_tells_totals_mean_worst_and_rate() -> None:
    text = plain_text(made({}, [1000, 3000, 2000]), CLOCK)
    assert "3 frames, end of the clip" in text
    assert "6,005 cycles (5 before the first frame), 6,005 instructions" in text
    assert "2,000.0 on average, 3,000 at worst (frame 1)" in text
    assert "10 MHz (illustrative): 5,000 on average, 3,333 at worst" in text
    assert "exposure time is not counted" in text


def test_a_frame_cut_short_is_neither_averaged_nor_worst() -> None:
    result = made({}, [1000, 90_000], last_complete=False, status="cycle-limit")
    text = plain_text(result, CLOCK)
    assert "2 frames, the last one cut short, CYCLE LIMIT REACHED" in text
    assert "1,000.0 on average, 1,000 at worst (frame 0)" in text


def test_program_without_frames_shows_its_set_up() -> None:
    setup = FrameRecord(cycles=9, instructions=9, outputs={"sum": 42})
    text = plain_text(made({"sum": np.zeros(0, np.int32)}, [], setup=setup, status="halted"), CLOCK)
    assert data(text) == [["frame", "sum", "cycles"], ["setup", "42", "9"]]
    assert "on average" not in text


@pytest.mark.parametrize(
    ("hz", "text"),
    [(1, "1 Hz"), (32768, "32.768 kHz"), (10_500_000, "10.5 MHz"), (2 * 10**9, "2 GHz")],
)
def test_clock_reads_well(hz: int, text: str) -> None:
    assert str(Clock(hz, stated=True)) == text
    assert str(Clock(hz, stated=False)) == f"{text} (illustrative)"


def test_free_instructions_divide_nothing_by_zero() -> None:
    assert "- on average" in plain_text(made({}, [0]), CLOCK)


def test_terminal_shows_a_short_clip_whole() -> None:
    text = without_colors(terminal_text(made({}, [5] * 40), CLOCK, 80))
    assert sum(line.split()[:1] == [str(k)] for k in range(40) for line in text.splitlines()) == 40
    assert "not shown" not in text


def test_terminal_shows_ends_and_worst_of_a_long_clip() -> None:
    cycles = [10] * 1000
    cycles[500] = 99
    text = without_colors(terminal_text(made({}, cycles), CLOCK, 80))
    shown = [line.split()[0] for line in text.splitlines() if re.match(r" *[\d.]+ +[\d.]+$", line)]
    assert shown == [*map(str, range(20)), "...", "500", "...", *map(str, range(985, 1000))]
    assert "964 frames are not shown" in text


def test_terminal_loses_no_digit_in_a_narrow_window() -> None:
    text = without_colors(terminal_text(imaged(np.zeros((1, 64, 80), np.uint8)), CLOCK, 200))
    assert "64x80" in text
    outputs = {f"output_number_{k}": np.array([200 + k], np.int32) for k in range(9)}
    narrow = without_colors(terminal_text(made(outputs, [1900]), CLOCK, 80))
    assert all(str(200 + k) in narrow for k in range(9))


def test_no_color(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    text = terminal_text(made({}, [1, 2]), CLOCK, 80)
    assert not re.search(r"\x1b\[[\d;]*3\d", text)
