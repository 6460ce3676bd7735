"""Breakpoints of a file when the program has changed: they follow their instructions, or say so."""

from __future__ import annotations

from pathlib import Path

import pytest

from npchip import InputError, Program, assemble_text
from npchip.debugger import store
from npchip.debugger.session import Debugger

BEFORE = """start:
 MOV r0, #0
.macro two x
 ADD x, #1
 ADD x, #2
.endm
loop: ADD r0, #1
 two r1
 SUB r2, #1
 ADD r0, #1
 CMP r0, #9
 JANY NE, loop
 HALT
"""
STOPS = ["x.s:9", "line 10 if any r0 > 3", "x.s:5", "x.s:8", "7", "loop + 4", "loop", "frame == 1"]


def reloaded(tmp_path: Path, after: str, stops: list[str] = STOPS) -> tuple[list[str], list[str]]:
    """Texts and messages after the program has changed."""
    path = tmp_path / "x.breakpoints.yaml"
    first = Debugger(assemble_text(BEFORE, "x.s", name="x"))
    for stop in stops:
        first.add(stop)
    store.save(first, path)
    again = Debugger(assemble_text(after, "x.s", name="x"))
    messages = store.load(again, path)
    assert all(message.startswith(f"{path}:") for message in messages)
    return [item.text for item in again.breakpoints.values()], [
        message.split(": ", 1)[1] for message in messages
    ]


def test_without_a_change_nothing_is_said(tmp_path: Path) -> None:
    assert reloaded(tmp_path, BEFORE) == (STOPS, [])


def test_lines_and_words_above_move_breakpoints(tmp_path: Path) -> None:
    texts, messages = reloaded(tmp_path, "; a remark\n\n" + BEFORE)
    moved = ["x.s:11", "line 12 if any r0 > 3", "x.s:7", "x.s:10"]
    assert texts == [*moved, *STOPS[4:]]
    assert messages == [f"{old} is {new} now" for old, new in zip(STOPS, moved, strict=False)]
    texts, messages = reloaded(tmp_path, BEFORE.replace("loop:", " NOP\n ADD r0, #1\nloop:"))
    assert texts == [
        "x.s:11", "line 12 if any r0 > 3", "x.s:5", "x.s:10", "9", "loop + 4", "loop", "frame == 1"
    ]  # fmt: skip
    texts, _ = reloaded(tmp_path, BEFORE.replace("two r1", "two r1\n two r3\n NOP"))
    assert texts[:6] == ["x.s:11", "line 12 if any r0 > 3", "x.s:5", "x.s:8", "10", "loop + 7"]


def test_a_changed_instruction_stays_where_it_is(tmp_path: Path) -> None:
    texts, messages = reloaded(tmp_path, "\n" + BEFORE.replace("SUB r2, #1", "SUB r2, #2 ; so"))
    assert texts[0] == "x.s:10"
    assert len(messages) == 4


def test_an_instruction_that_is_gone_is_told(tmp_path: Path) -> None:
    texts, messages = reloaded(tmp_path, BEFORE.replace(" SUB r2, #1\n", ""), STOPS[:1])
    assert texts == ["x.s:9"]
    assert messages == ["x.s:9 is another instruction now, or none: SUB r2, #1"]
    texts, messages = reloaded(tmp_path, "NOP\nHALT\n", ["x.s:11", "7"])
    assert messages == [
        "x.s:11 is another instruction now, or none: CMP r0, #9",
        "x.s has no instruction below line 2",
        "7 is another instruction now, or none",
        "address 7: the program ends at 1",
    ]


def test_a_place_that_was_changed_by_hand_is_taken_as_it_is(tmp_path: Path) -> None:
    reloaded(tmp_path, BEFORE, ["x.s:9"])
    path = tmp_path / "x.breakpoints.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("stop: x.s:9", "stop: x.s:10"))
    again = Debugger(assemble_text("\n" + BEFORE, "x.s"))
    assert store.load(again, path) == []
    assert again.breakpoints[1].text == "x.s:10"


def test_a_program_without_source_is_followed_by_its_words(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    words = assemble_text(BEFORE, "x.s").words
    debugger = Debugger(Program("raw", words))
    debugger.add("4")
    store.save(debugger, path)
    again = Debugger(Program("raw", (words[0], *words)))
    assert store.load(again, path) == [f"{path}:3: 4 is 5 now"]


@pytest.mark.parametrize(
    "text",
    [
        "breakpoints: [{stop: x.s:9, at: [5]}]\n",
        "breakpoints: [{stop: x.s:9}]\nwords: abcd\nplaces: [5]\n",
        "breakpoints: [{stop: x.s:9}]\nwords: abcd\nplaces: {x.s:9: 5}\n",
        "breakpoints: [{stop: x.s:9}]\nwords: abcd\nplaces: {x.s:9: {at: 5}}\n",
        "breakpoints: [{stop: x.s:9}]\nwords: abcd\nplaces: {x.s:9: {at: [5], line: 7}}\n",
        "breakpoints: []\nwords: abc\n",
        "breakpoints: []\nwords: 1234\n",
        f"breakpoints: []\nwords: {'abcd ' * 1025}\n",
    ],
)
def test_damaged_files_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="NP355"):
        store.load(Debugger(assemble_text(BEFORE, "x.s")), path)


def test_addresses_that_are_none_are_lost(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(
        "breakpoints: [{stop: x.s:9}]\nwords: abcd\nplaces: {x.s:9: {at: [-1, 600, x, [1]]}}\n",
        encoding="utf-8",
    )
    (message,) = store.load(Debugger(assemble_text(BEFORE, "x.s")), path)
    assert "is another instruction now" in message
