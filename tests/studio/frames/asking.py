"""Questions to the page's frames: a process of Node answers, itself or by a browser."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import Fit, open_frames
from tests.support.page_code import DRIVES, OLDEST, PUPPETEER, Answers, Bundles, here
from tests.support.page_code import browser as find_browser

ASK = Path(__file__).with_name("ask.mjs")
BROWSERS = {"chrome": "chromium", "firefox": "firefox"}
"""Browsers by the name that puppeteer gives them."""

Answer = NDArray[np.uint8] | str
"""Frames, or the code of a mistake."""


class Frames:
    """The page's frames in an engine."""

    def __init__(self, answers: Answers, kind: str) -> None:
        self._answers = answers
        self.kind = kind

    def ask(self, what: str, /, **question: Any) -> Any:
        """Return the answer to a question of `probe.ts`."""
        return self._answers.ask({"ask": what, **question})

    def open(
        self, *paths: Path, size: tuple[int, int] = (64, 80), fit: Fit | None = None
    ) -> dict[str, Any]:
        """Open files; return the answer with the frames as an array, if there are any."""
        files = [
            {"name": path.name, "data": base64.b64encode(path.read_bytes()).decode()}
            for path in paths
        ]
        answer: dict[str, Any] = self.ask("open", files=files, size=size, fit=fit)
        if "data" in answer:
            answer["frames"] = array_of(answer)
        return answer


def array_of(answer: dict[str, Any]) -> NDArray[np.uint8]:
    """Return the frames of an answer."""
    data = np.frombuffer(base64.b64decode(answer["data"]), np.uint8)
    return data.reshape(answer["shape"])


def expected(path: Path, size: tuple[int, int] = (64, 80), fit: Fit | None = None) -> Answer:
    """Return npchip's own frames of a path, or the code of its error."""
    try:
        return np.stack(list(open_frames(path, *size, fit)))
    except InputError as error:
        return error.code


def found(answer: dict[str, Any]) -> Answer:
    """Return the page's frames, or the code of its error."""
    return answer["frames"] if "frames" in answer else str(answer["error"])


def same(one: Answer, other: Answer) -> bool:
    """Tell whether two answers are the same frames, or the same error."""
    if isinstance(one, str) or isinstance(other, str):
        return isinstance(one, str) and isinstance(other, str) and one == other
    return np.array_equal(one, other)


@contextmanager
def engine(kind: str, folder: Path, bundles: Bundles) -> Iterator[Frames]:
    """Start Node, or a browser that also serves a folder; skip the test where that cannot be."""
    rest: list[Path]
    if kind == "node":
        probe = bundles.for_node("frames/probe.ts")
        rest, least = [], OLDEST
    else:
        probe = bundles.for_browsers("frames/probe.ts")
        browser = here(lambda: find_browser(BROWSERS[kind]))
        rest, least = [browser, PUPPETEER, folder], DRIVES
    with Answers(ASK, probe, kind, *rest, least=least) as answers:
        yield Frames(answers, kind)
