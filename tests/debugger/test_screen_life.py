"""The terminal application when something goes wrong: no key is lost, and no fault is hidden."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner
from textual.app import App
from textual.events import AppBlur, AppFocus, Key
from textual.widgets import Input

from npchip import assemble_text
from npchip.cli import debug
from npchip.cli.main import cli
from npchip.debugger.screen.app import DebugApp
from npchip.debugger.screen.panes import Panes
from npchip.debugger.screen.picture import Picture
from npchip.debugger.screen.source import Source
from npchip.debugger.session import Debugger
from tests.support.screen_driver import Driver, drive

NAMES = {":": "colon", " ": "space", "\n": "enter", "\x1b": "escape", "?": "question_mark"}


def counting() -> Debugger:
    return Debugger(assemble_text(" ADD r0, #1\n" * 20 + " HALT\n", "x.s"))


async def at_once(driver: Driver, keys: str) -> None:
    """Press keys as fast as a terminal can send them."""
    for key in keys:
        driver.app.post_message(Key(NAMES.get(key, key), key if key.isprintable() else None))
    await settled(driver)


async def settled(driver: Driver) -> None:
    for _ in range(5):
        await driver.pilot.pause()
        while driver.app._worker.busy:  # noqa: SLF001
            await driver.pilot.pause(0.01)


@pytest.mark.long
def test_after_a_wrong_command_the_next_keys_do_their_work() -> None:
    async def work(driver: Driver) -> None:
        await driver.command("frob")
        assert not driver.popup
        assert driver.text("message").startswith("error: no command 'frob' [NP351]: commands: ")
        await driver.press("s")
        assert driver.debugger.time == 1
        await driver.command("step 0")
        assert "expected a number from 1 on, found 0 [NP351]" in driver.text("message")
        await driver.command("show nothing")
        assert "no register or label 'nothing' [NP351]" in driver.text("message")
        await driver.command("np 8 0")
        assert "the NP's row from 0 to 7, found 8 [NP351]" in driver.text("message")
        await driver.command("step 3")
        assert driver.debugger.time == 4
        assert not driver.popup

    drive(counting(), work)


@pytest.mark.long
def test_a_key_closes_a_long_answer_and_does_its_work() -> None:
    async def work(driver: Driver) -> None:
        for keys, steps in (("s", 1), ("ss", 3), ("\x1bs", 4), (" s", 5), (":step 3\n", 8)):
            await driver.command("print r3")
            assert driver.popup
            await at_once(driver, keys)
            assert not driver.popup
            assert driver.debugger.time == steps
        await driver.press("question_mark", "down", "pagedown", "up")
        assert driver.popup
        assert "any other key closes" in str(driver.popup.query("*").first().border_subtitle)
        await at_once(driver, "q?")
        assert driver.popup
        await at_once(driver, "\nl")
        assert not driver.popup
        assert "NP (0,1)" in driver.text("np-head")
        await at_once(driver, ":step x1\ns")
        assert not driver.popup
        assert driver.debugger.time == 9

    drive(counting(), work)


@pytest.mark.long
def test_the_command_line_closes_when_the_keys_go_elsewhere() -> None:
    async def work(driver: Driver) -> None:
        shown = driver.app.query_one("#command", Input).styles
        for place in (Source, Picture):
            await driver.press("colon", "s", "t")
            assert shown.display == "block"
            await driver.pilot.click(place)
            await driver.pilot.pause()
            assert shown.display == "none"
        await driver.press("s")
        assert driver.debugger.time == 1
        await driver.press("colon", "s")
        driver.app.post_message(AppBlur())  # another window
        await driver.pilot.pause()
        driver.app.post_message(AppFocus())
        await driver.press("enter")
        assert driver.debugger.time == 2

    drive(counting(), work)


@pytest.mark.long
@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(5, "Input/output error", "clip.npy"), "error: [Errno 5] Input/output error"),
        (MemoryError(), "error: no memory is left"),
    ],
)
def test_what_the_system_refuses_is_a_message(
    error: Exception, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def gone() -> Any:
        raise error

    debugger = counting()
    monkeypatch.setattr(debugger, "restart", gone)

    async def work(driver: Driver) -> None:
        await driver.press("0")
        assert driver.text("message").startswith(said)
        await driver.press("s")
        assert debugger.time == 1

    drive(debugger, work)


@pytest.mark.long
def test_a_tiny_terminal_shows_the_next_instruction() -> None:
    async def work(driver: Driver) -> None:
        await driver.press("s", "s", "s", "s")
        source = driver.source
        assert (source.cursor, source.scroll_offset.y, source.size.height) == (4, 4, 1)
        await driver.press("question_mark", "down", "q", "l", "p", "tab", "t")

    drive(counting(), work, size=(20, 5))


def broken(*_: object, **__: object) -> Any:
    raise ZeroDivisionError("a mistake in the screen")


@pytest.mark.long
@pytest.mark.parametrize(("owner", "name"), [(Panes, "show"), (Debugger, "step")])
def test_a_fault_in_the_screen_is_an_internal_error(
    owner: type, name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    source = tmp_path / "x.s"
    source.write_text(" NOP\n HALT\n", encoding="utf-8")

    async def press(pilot: Any) -> None:
        await pilot.press("s")
        await pilot.pause(0.1)

    def run(app: DebugApp) -> None:
        with contextlib.suppress(BaseException):  # a pilot reports the fault, too
            App.run(app, headless=True, auto_pilot=press)

    stream = SimpleNamespace(isatty=lambda: True)
    terminal = SimpleNamespace(stdin=stream, stdout=stream, exit=sys.exit)
    monkeypatch.setattr(owner, name, broken)
    monkeypatch.setattr(DebugApp, "run", run)
    monkeypatch.setattr(debug, "sys", terminal)
    done = CliRunner().invoke(cli, ["debug", str(source)])
    assert done.exit_code == 70
    assert "internal error: ZeroDivisionError: a mistake in the screen [NP259]" in done.stderr
    assert "Traceback" not in done.output
