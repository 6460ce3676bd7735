"""Draw the screens of docs/debugging.md: ``python -m examples.debugger_figures [FOLDER]``.

Each is a session in a terminal of 120 x 40 without anybody at the keys.
"""

from __future__ import annotations

import asyncio
import re
from pathlib import Path

from examples.target import asked
from npchip import assemble
from npchip.debugger.screen.app import DebugApp
from npchip.debugger.session import Debugger
from npchip.frames import open_frames

ROOT = Path(__file__).parents[1]
SIZE = (120, 40)
SCREENS = {
    "debugger-values": (":break edge_tracer.s:83", "r", ":show x", *"llljj"),
    "debugger-frame": (":break edge_tracer.s:127", "r", *"lllljj"),
    "debugger-who": (
        ":break side + 1 if any stored == 11",
        "r",
        ":show mem[BITS + 11]",
        "w",
    ),
    "debugger-help": ("question_mark",),
}
"""Keys by screen; what begins with a colon is typed into the command line."""


async def screen(keys: tuple[str, ...], size: tuple[int, int] = SIZE) -> str:
    """Press keys in a new session of the program with the mistake; returns the screen as SVG."""
    program = assemble(
        ROOT / "examples" / "debugging" / "keypoints_total.s", include_paths=[ROOT / "asm"]
    )
    clip = open_frames(ROOT / "examples" / "clips" / "shapes_photo.npy", 64, 80)
    app = DebugApp(Debugger(program, clip))
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        for key in keys:
            if key.startswith(":"):
                app.open_command(key[1:])
                await pilot.press("enter")
            else:
                await pilot.press(key)
            await pilot.pause()
            await app.workers.wait_for_complete()
            await pilot.pause()
        return app.export_screenshot(title="npchip debug", simplify=True)


def compact(svg: str) -> str:
    """Return a screen without what every cell repeats; it looks the same."""
    svg = re.sub(r"terminal-\d+", "t", svg)  # a name that is unique in a page of many
    svg = re.sub(r' clip-path="url\(#t-line-\d+\)"| shape-rendering="crispEdges"', "", svg)
    svg = re.sub(r'<clipPath id="t-line-\d+">\s*<rect [^>]*/>\s*</clipPath>\s*', "", svg)
    return svg.replace("<style>", "<style>\n    rect { shape-rendering: crispEdges }", 1)


def main() -> None:
    """Write all screens."""
    folder = asked(ROOT / "docs" / "figures")
    for name, keys in SCREENS.items():
        text = compact(asyncio.run(screen(keys)))
        (folder / f"{name}.svg").write_text(text, encoding="utf-8")
        print(f"{folder / name}.svg: {len(text):,} characters")


if __name__ == "__main__":
    main()
