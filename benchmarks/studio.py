"""The studio in real browsers, by the clock: how soon, how fast, how much."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import REPEATS
from benchmarks.programs import CLIP, ROOT
from npchip import Chip, assemble
from npchip.studio.places import site_files
from tests.studio.browser import tools
from tests.studio.browser.driver import SECONDS, Driver
from tests.studio.browser.servers import serve_site
from tests.support import page_code

FRAMES = 40_000
"""Frames of the clip for speeds; they take some 70 ms."""
BACK_AT = 2_000_000
BACK_FRAMES = 6_000
VISITS = 3
WORDS = 200

Table = dict[str, dict[str, float]]


def studio() -> Table:
    """Measure the built page in Chromium and Firefox; what is missing is said and left out."""
    try:
        site, node = page_code.site(), page_code.node(page_code.DRIVES)
    except page_code.MissingError as error:
        print(f"studio: left out, as {error}")
        return {}
    table = {"transfer, gzipped": transfer(site)}
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        script = tools.bundled(folder)
        url = stack.enter_context(serve_site(site))
        for kind in page_code.KINDS:
            try:
                executable = page_code.browser(kind)
            except page_code.MissingError as error:
                print(f"studio: {kind} is left out, as {error}")
                continue
            driver = Driver(kind, executable, node, script, tools.film(folder / "camera.y4m"))
            with _closing(driver):
                table |= {f"{kind}: {name}": row for name, row in in_browser(driver, url, folder)}
    return table


@contextmanager
def _closing(driver: Driver) -> Iterator[None]:
    try:
        yield
    finally:
        driver.close()


def in_browser(driver: Driver, url: str, folder: Path) -> Iterator[tuple[str, dict[str, float]]]:
    """Measure one browser, and give the rows of the table by name."""
    visits = [_run(driver, "loading", url, folder) for _ in range(VISITS)]
    for visit in ("first", "second"):
        for key, name in (("picture", "first picture"), ("ready", "ready to assemble")):
            seconds = statistics.median(each[visit][key] for each in visits)
            yield f"{name}, {visit} visit", {"s": seconds}
    yield "memory of the page", {"MB": statistics.median(each["megabytes"] for each in visits)}
    edits = _run(driver, "editing", url, folder, program=program(), rounds=REPEATS)
    row = {"ms": 1000 * statistics.median(edits["seconds"]), "words": edits["words"]}
    yield "edit to result", row
    back = _run(
        driver, "back", url, folder, instruction=BACK_AT, frames=BACK_FRAMES, rounds=REPEATS
    )
    yield "back at instruction 2,000,000", {"ms": 1000 * statistics.median(back["seconds"])}
    yield "frames of trajectory.s", speed(driver, url, folder)


def speed(driver: Driver, url: str, folder: Path) -> dict[str, float]:
    """Frames a second of `trajectory.s` in the page and by `Chip.run`, in turn."""
    clip = np.load(CLIP)
    frames = np.resize(clip, (FRAMES, *clip.shape[1:]))
    chip = Chip(assemble(ROOT / "asm" / "trajectory.s"))
    chip.run(clip)
    page: list[float] = []
    own: list[float] = []
    for _ in range(VISITS):
        for _ in range(2):
            chip.reset()
            start = time.perf_counter()
            chip.run(frames)
            own.append(time.perf_counter() - start)
        found = _run(driver, "frames a second", url, folder, frames=FRAMES, rounds=2)
        page += found["seconds"]
    ours, theirs = statistics.median(page), statistics.median(own)
    return {
        "frames/s": FRAMES / ours,
        "Chip.run frames/s": FRAMES / theirs,
        "times of Chip.run": theirs / ours,
    }


def program() -> str:
    """Return `trajectory.s` with as many more instructions as make `WORDS` words."""
    path = ROOT / "asm" / "trajectory.s"
    lines = path.read_text(encoding="utf-8").splitlines()
    lines = [line for line in lines if not line.startswith(".budget") and "expect:" not in line]
    first = next(k for k, line in enumerate(lines) if line.startswith("frame:"))
    lines[first:first] = ["        MOV     r0, #0"] * (WORDS - len(assemble(path).words))
    return "\n".join(lines) + "\n"


def transfer(site: Path) -> dict[str, float]:
    """Add up what the server sends for the whole page: compressed copies where there are any."""
    sizes = {"MB": 0.0, "snapshot MB": 0.0}
    for path in site_files(site):
        packed = path.with_name(f"{path.name}.gz")
        key = "snapshot MB" if "snapshot" in path.name else "MB"
        sizes[key] += (packed if packed.exists() else path).stat().st_size / 1e6
    return sizes


def _run(driver: Driver, flow: str, url: str, folder: Path, **parameters: object) -> Any:
    return driver.run(f"measure: {flow}", url, folder / "failed", SECONDS, **parameters)
