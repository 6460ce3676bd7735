"""The terminal application: every key, in a terminal without anybody at it."""

from __future__ import annotations

import asyncio
import html
import re
import time
from pathlib import Path

import numpy as np
import pytest
from textual.events import Key
from textual.widgets import Input, Static

from examples import debugger_figures
from npchip import assemble_text
from npchip.debugger import store
from npchip.debugger.screen.keys import KEYS
from npchip.debugger.screen.panes import Outputs
from npchip.debugger.screen.picture import Picture
from npchip.debugger.screen.source import Source, squeezed
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell
from npchip.program.model import Program
from tests.support.chips import clip_of, machine_of
from tests.support.clips import bundled_clips
from tests.support.screen_driver import Driver, drive, trajectory

ROOT = Path(__file__).parents[2]


@pytest.mark.long
def test_keys_that_move() -> None:
    async def work(driver: Driver) -> None:
        debugger, press = driver.debugger, driver.press
        await press("s", "s", "s")
        assert debugger.time == 3
        await press("S")
        assert debugger.time == 2
        await press("o")
        assert debugger.chip.pc == 1
        await press("0")
        assert debugger.time == 0
        await press("n")
        assert debugger.chip.pc == 1
        await press("f", "f")
        assert debugger.chip.frames_taken == 3
        assert "frame 2: 1 cycles" in driver.text("counters")
        await press("F")
        assert debugger.chip.frames_taken == 2
        await press("r")
        assert driver.reason == "frames-exhausted"
        assert "since stop" in driver.text("counters")
        assert "no frame is left" in driver.text("message")
        last = len(bundled_clips()["coin_slide"]) - 1
        assert driver.text("outputs").splitlines()[-1].split()[0] == str(last)
        await press("R")
        assert debugger.time == 0

    drive(trajectory(), work)


@pytest.mark.long
def test_breakpoints_at_the_cursor(tmp_path: Path) -> None:
    path = tmp_path / "t.breakpoints.yaml"

    async def work(driver: Driver) -> None:
        debugger, press = driver.debugger, driver.press
        start = driver.source.cursor
        await press("down", "down")
        assert driver.source.cursor == start + 2
        await press("up", "pagedown", "pageup", "down")
        assert driver.source.cursor == start + 2
        await press("c")
        assert driver.reason == "place"
        assert driver.source.cursor == start + 2
        await press("b")
        assert [item.text for item in debugger.breakpoints.values()] == ["frame"]
        assert "stop: frame" in path.read_text(encoding="utf-8")
        await press("0", "r", "r")
        assert driver.reason == "breakpoint"
        assert debugger.chip.pc == debugger.program.labels["frame"]
        await press("R")
        assert driver.reason == "breakpoint"
        await press("b")
        assert not debugger.breakpoints
        store.load(debugger, path)
        assert not debugger.breakpoints
        await press("down", "space")
        assert [item.text for item in debugger.breakpoints.values()] == [
            f"trajectory.s:{driver.source.rows[driver.source.cursor].number}"
        ]
        await press("down", "down", "down", "down", "t")
        assert driver.source.file.endswith("trajectory_common.s")
        await press("c", "b")
        assert driver.text("message") == "no instruction at the cursor"

    drive(trajectory(), work, breakpoints=path)


@pytest.mark.long
def test_what_is_shown_and_selected() -> None:
    async def work(driver: Driver) -> None:
        debugger, press = driver.debugger, driver.press
        await press("f", "l", "l", "j", "j", "k", "h")
        assert "NP (1,1)" in driver.text("np-head")
        await press("L", "J", "J", "K", "H", "L")
        frame = debugger.chip.frame
        assert frame is not None
        assert f"exposed frame   pixel(9,9) = {frame[9, 9]}" in driver.text("picture-head")
        await press("right_square_bracket", "right_square_bracket")
        assert driver.text("picture-head").startswith(" bank 64")
        await press("left_square_bracket", "left_square_bracket", "left_square_bracket")
        assert driver.text("picture-head").startswith(" bank 192")
        await press("p")
        assert driver.text("picture-head").startswith(" r0 pixel")
        await press("left_square_bracket")
        assert driver.text("picture-head").startswith(" active")
        await press("p")
        assert driver.text("picture-head").startswith(" bank 192")
        assert [driver.text(name)[0] for name in ("source-head", "picture-head")] == ["▸", " "]
        await press("tab")
        assert driver.focused == "Picture"
        assert [driver.text(name)[0] for name in ("source-head", "picture-head")] == [" ", "▸"]
        await press("right", "down", "left")
        assert "NP (2,1)" in driver.text("np-head")
        await press("tab")
        assert driver.focused == "Source"
        await driver.command("np 7 9")
        assert "NP (7,9)" in driver.text("np-head")
        await driver.command("show mem[0x12]")
        assert driver.text("picture-head").startswith(" mem[18]")
        await driver.command("show frame")
        assert driver.text("picture-head").startswith(" exposed frame")
        await driver.command("show nothing")
        await press("escape")
        assert "no register or label 'nothing'" in driver.text("message")
        await driver.command("np 0 0")
        await driver.pilot.click(Picture, offset=(17, 9))
        assert "NP (2,2)" in driver.text("np-head")
        await driver.pilot.click(Source, offset=(5, 3))
        assert driver.source.cursor == driver.source.scroll_offset.y + 3

    drive(trajectory(), work)


@pytest.mark.long
def test_who_go_edit() -> None:
    async def work(driver: Driver) -> None:
        debugger, press = driver.debugger, driver.press
        await press("f", "f")
        await press("g")
        assert "w finds out" in driver.text("message")
        await driver.command("show pixel")
        await press("l", "w")
        assert "np(0,1).r0:" in driver.text("message")
        match = re.search(r"goto (\d+), address (\d+)", driver.text("message"))
        assert match
        await press("g")
        assert (debugger.time, debugger.chip.pc) == (int(match[1]) - 1, int(match[2]))
        await press("e")
        line = driver.app.query_one("#command", Input)
        assert line.value == "edit np(0,1).r0 = "
        line.value += "77"
        await press("enter")
        assert debugger.chip.registers[0, 0, 1] == 77
        assert "np(0,1).r0 = 77" in driver.text("message")
        await driver.command("who np(0,1).r0")
        assert "by an edit" in driver.text("message")

    drive(trajectory(), work)


@pytest.mark.long
def test_command_line_and_popups() -> None:
    async def work(driver: Driver) -> None:
        press, app = driver.press, driver.app
        await press("question_mark")
        assert driver.popup
        shown = str(driver.popup.query_one(Static).render())
        assert all(keys.text in shown for keys in KEYS)
        await press("down", "escape")
        assert not driver.popup
        await press("colon", "s", "t", "e", "p", "space", "5", "left", "right", "enter")
        assert driver.debugger.time == 5
        await press("colon", "escape")
        assert app.query_one("#command", Input).styles.display == "none"
        await driver.command("print r3")
        assert driver.popup
        await press("escape")
        await driver.command("brake frame")
        await press("escape")
        assert "no command 'brake'" in driver.text("message")
        await driver.command("help")
        assert driver.popup
        await press("q")
        await press("q")
        assert app.return_code == 0

    drive(trajectory(), work)


@pytest.mark.long
def test_keys_that_come_in_one_go_are_taken_in_their_order() -> None:
    async def work(driver: Driver) -> None:
        line = driver.app.query_one("#command", Input)
        names = {":": "colon", " ": "space"}
        for keys, expected in (("lle", "edit pixel(0,16) = "), (":step 50q", "step 50q")):
            for key in keys:
                driver.app.post_message(Key(names.get(key, key), key))
            for _ in range(3):
                await driver.pilot.pause()
            assert line.value == expected
            await driver.press("escape")
        assert driver.debugger.time == 0

    drive(trajectory(), work)


@pytest.mark.long
def test_the_source_moves_sideways() -> None:
    async def work(driver: Driver) -> None:
        await driver.press("t")
        source = driver.source

        def first() -> str:
            return source.render_line(0).text[13:].rstrip()

        whole = squeezed(source.rows[source.scroll_offset.y].text)
        assert first() == whole[: source.size.width - 13]
        await driver.press("right", "right")
        assert first() == whole[16 : source.size.width + 3]
        await driver.press(*["right"] * 40)
        assert any(source.render_line(y).text[13:].strip() for y in range(len(source.rows)))
        await driver.press(*["left"] * 41)
        assert first() == whole[: source.size.width - 13]

    drive(trajectory(), work)


@pytest.mark.long
def test_a_long_run_can_be_interrupted_and_the_screen_lives() -> None:
    machine = machine_of()
    program = assemble_text("loop: ADD r0, #1\n JMP loop\n", "l.s", machine)
    debugger = Debugger(program, None, machine, max_cycles=10**9)

    async def work(driver: Driver) -> None:
        await driver.pilot.press("r")
        await driver.pilot.pause(0.5)
        assert "working: frame -1" in driver.text("message")
        await driver.pilot.press("l")  # the screen answers
        assert "NP (0,1)" in driver.text("np-head")
        await driver.press("escape")
        assert driver.reason == "interrupted"
        time = debugger.time
        await driver.press("s")
        assert debugger.time == time + 1

    drive(debugger, work)


@pytest.mark.long
def test_leaving_ends_a_run() -> None:
    machine = machine_of()
    program = assemble_text("loop: ADD r0, #1\n JMP loop\n", "l.s", machine)
    debugger = Debugger(program, None, machine, max_cycles=10**9)

    async def work(driver: Driver) -> None:
        await driver.pilot.press("r")
        await driver.pilot.pause(0.2)
        await driver.pilot.press("q")

    drive(debugger, work)
    for _ in range(100):
        if debugger.stop.reason == "interrupted":
            return
        time.sleep(0.05)
    raise AssertionError("it still runs")


@pytest.mark.long
def test_a_small_terminal_scrolls_to_the_selected_np() -> None:
    async def work(driver: Driver) -> None:
        picture = driver.app.query_one(Picture)
        assert picture.size.width < 80
        assert picture.size.height < 32
        await driver.press("f", *"jjjjjj", *"llllllll")
        row, column = 6, 8
        x, y = picture.scroll_offset
        assert x <= 8 * column <= x + picture.size.width - 8
        assert y <= 4 * row <= y + picture.size.height - 4

    drive(trajectory(), work, size=(80, 24))


@pytest.mark.long
def test_outputs_take_the_room_that_there_is() -> None:
    async def work(driver: Driver) -> None:
        await driver.press("r")
        outputs = driver.app.query_one(Outputs)
        for wide in (80, 160, 90):
            await driver.pilot.resize_terminal(wide, 40)
            await driver.pilot.pause()
            first = str(outputs.render()).splitlines()[0]
            assert first.endswith("…") == (wide != 160)
            assert wide == 160 or len(first) == outputs.size.width

    drive(trajectory(), work, size=(100, 40))


@pytest.mark.long
def test_on_120_by_40_the_whole_array_is_there() -> None:
    async def work(driver: Driver) -> None:
        picture = driver.app.query_one(Picture)
        assert (picture.size.width, picture.size.height) >= (80, 32)
        assert not picture.show_horizontal_scrollbar
        assert not picture.show_vertical_scrollbar
        await driver.press("f")
        frame = driver.debugger.chip.frame
        assert frame is not None
        for y in (5, 31):  # away from the corners of the selected NP
            segments = [s for s in picture.render_line(y) for _ in s.text]
            for x in (8, 40, 79):
                style = segments[x].style
                assert style is not None
                assert style.color is not None
                assert style.bgcolor is not None
                ink, paper = style.color.get_truecolor(), style.bgcolor.get_truecolor()
                assert (ink[0], paper[0]) == (frame[2 * y, x], frame[2 * y + 1, x])

    drive(trajectory(), work, size=(120, 40))


@pytest.mark.long
def test_inactive_nps_are_seen_without_colour() -> None:
    machine = machine_of()
    text = "COL r1\n CMP r1, #2\n WHERE LO\n NOP\n END\n HALT\n"
    debugger = Debugger(assemble_text(text, "m.s", machine), clip_of(1, machine), machine)

    async def work(driver: Driver) -> None:
        await driver.press("s", "s", "s", "l", "l", "l")
        picture = driver.app.query_one(Picture)
        assert "INACTIVE" in driver.text("np")
        for shown in ("frame", "r1"):
            await driver.command(f"show {shown}")
            line = picture.render_line(0).text
            assert ["╲" in line[8 * column : 8 * column + 8] for column in range(4)] == [
                False,
                False,
                True,
                True,
            ]
            assert line[24] == "┏"

    drive(debugger, work)


@pytest.mark.long
def test_a_program_without_source_is_disassembled() -> None:
    machine = machine_of()
    words = assemble_text("ROW r3\n HALT\n", "x.s", machine).words
    debugger = Debugger(Program("raw", (*words, 0)), None, machine)

    async def work(driver: Driver) -> None:
        assert [row.text for row in driver.source.rows] == ["ROW r3", "HALT", ".word 0x0000"]
        await driver.press("r")
        assert driver.reason == "halted"

    drive(debugger, work)


def words_of(svg: str) -> list[str]:
    """The texts of a screen, without names and places that differ between versions."""
    found = re.findall(r"<text[^>]*>(.*?)</text>", svg, re.DOTALL)
    return " ".join(html.unescape(item).replace("\xa0", " ") for item in found).split()


@pytest.mark.long
@pytest.mark.parametrize("name", debugger_figures.SCREENS)
def test_the_checked_in_screens_are_what_it_draws(name: str) -> None:
    checked_in = (ROOT / "docs" / "figures" / f"{name}.svg").read_text(encoding="utf-8")
    drawn = asyncio.run(debugger_figures.screen(debugger_figures.SCREENS[name]))
    assert words_of(checked_in) == words_of(drawn)
    assert len(words_of(drawn)) > 100


def test_the_picture_of_a_moment_is_a_copy() -> None:
    from npchip.debugger.screen.look import Look

    debugger = trajectory()
    debugger.next_frame()
    look = Look(debugger)
    before = look.registers.copy()
    debugger.step(100)
    np.testing.assert_array_equal(look.registers, before)
    assert Cell("register", 1).plane(look).shape == (8, 10)
