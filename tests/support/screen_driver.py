"""The terminal application without a terminal: keys are pressed, and what it shows is read."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import TYPE_CHECKING

from textual.widgets import Input, Static

from npchip.debugger.screen.app import DebugApp
from npchip.debugger.screen.popup import Popup
from npchip.debugger.screen.source import Source
from npchip.debugger.session import Debugger
from tests.support.clips import bundled_clips
from tests.support.programs import assembled

if TYPE_CHECKING:
    from textual.pilot import Pilot

ROOT = Path(__file__).parents[2]


class Driver:
    """Presses keys and waits until the work is done."""

    def __init__(self, app: DebugApp, pilot: Pilot[None]) -> None:
        self.app = app
        self.pilot = pilot
        self.debugger = app._debugger  # noqa: SLF001 - what the keys are to change

    async def press(self, *keys: str) -> None:
        """Press keys; each has done what it does before the next."""
        for key in keys:
            await self.pilot.press(key)
            while self.app._worker.busy:  # noqa: SLF001
                await self.pilot.pause(0.01)

    async def command(self, text: str) -> None:
        """Type into the command line."""
        await self.press("colon")
        self.app.query_one("#command", Input).value = text
        await self.press("enter")

    def text(self, name: str) -> str:
        """Return the text of a pane."""
        return str(self.app.screen_stack[0].query_one(f"#{name}", Static).render())

    @property
    def focused(self) -> str:
        """The name of the part that has the focus."""
        return type(self.app.focused).__name__

    @property
    def reason(self) -> str:
        """The reason for the session's stop."""
        return self.debugger.stop.reason

    @property
    def popup(self) -> Popup | None:
        """The dialogue that lies over the screen."""
        return self.app.screen if isinstance(self.app.screen, Popup) else None

    @property
    def source(self) -> Source:
        """The source pane."""
        return self.app.query_one(Source)


def drive(
    debugger: Debugger,
    work: Callable[[Driver], Awaitable[None]],
    size: tuple[int, int] = (80, 24),
    breakpoints: Path | None = None,
) -> None:
    """Run the application and do some work in it."""

    async def run() -> None:
        app = DebugApp(debugger, breakpoints)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await work(Driver(app, pilot))

    asyncio.run(run())


def trajectory() -> Debugger:
    return Debugger(assembled("trajectory"), bundled_clips()["coin_slide"])
