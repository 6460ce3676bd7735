"""HTML for Jupyter, read by an HTML parser; pictures by Pillow."""

from __future__ import annotations

import base64
import io
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from npchip import Chip, Program, assemble_text
from npchip.program.model import Output
from npchip.run.html import Picture
from npchip.run.result import FrameRecord, RunError
from tests.support.chips import clip_of, machine_of
from tests.support.results import made

SOURCE = """
.reg wave, r3
.output <b>, 0, scalar
.output view, 1, plane
frame:  EXPOSE
        COL     wave
        CMP     wave, #2
        WHERE   LO
          OUT   1, wave
        END
        JMP     frame
""".replace("<b>", "count")


class Page(HTMLParser):
    """Texts, elements and pictures of a piece of HTML, which must be balanced."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.tags: list[str] = []
        self.images: list[np.ndarray[tuple[int, ...], np.dtype[np.uint8]]] = []
        self._open: list[str] = []
        self.feed(html)
        self.close()
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take an element."""
        self.tags.append(tag)
        if tag == "img":
            kind, _, data = (dict(attrs)["src"] or "").partition(",")
            assert kind == "data:image/png;base64"
            with Image.open(io.BytesIO(base64.b64decode(data))) as image:
                self.images.append(np.asarray(image))
        elif tag != "br":
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        """Close it."""
        assert self._open.pop() == tag

    def handle_data(self, data: str) -> None:
        """Take a text."""
        self.texts.append(data)


def page(thing: object) -> Page:
    return Page(thing._repr_html_())  # type: ignore[attr-defined]


def test_a_chip_shows_its_registers() -> None:
    machine = machine_of()
    chip = Chip(assemble_text(SOURCE, "x.s", machine), machine)
    clip = clip_of(2, machine)
    before = page(chip)
    assert len(before.images) == 16 + 3  # no frame yet
    chip.run(clip)
    shown = page(chip)
    assert len(shown.images) == 1 + 16 + 3
    np.testing.assert_array_equal(shown.images[0], clip[1])
    np.testing.assert_array_equal(shown.images[1 + 3], chip.registers[3])
    assert "r3 wave" in shown.texts
    assert "0 to 3" in shown.texts
    assert shown.texts[-1] == "all 1"  # NPs are active
    np.testing.assert_array_equal(shown.images[-1], np.full((3, 4), 255))


def test_a_result_shows_a_table() -> None:
    machine = machine_of()
    result = Chip(assemble_text(SOURCE, "x.s", machine), machine).run(clip_of(3, machine))
    shown = page(result)
    assert len(shown.images) == 3
    assert shown.images[0].tolist() == [[0, 1, 0, 0]] * 3
    assert shown.texts.count("–") == 3  # count was not sent
    assert shown.tags.count("tr") == 1 + 3


def test_a_long_result_shows_its_ends() -> None:
    result = made({"row": np.arange(1000, dtype=np.int32)}, [7] * 1000)
    texts = page(result).texts
    assert {"0", "11", "996", "999", "…"} <= set(texts)
    assert "500" not in texts


def test_a_long_list_is_cut() -> None:
    record = FrameRecord(5, 5, {"points": list(range(100)), "few": [1, 2]})
    texts = page(record).texts
    assert "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, … (100)" in texts
    assert "1, 2" in texts


def test_names_cannot_bring_html_in() -> None:
    evil = "<script>alert(1)</script>"
    result = made({evil: np.zeros(2, np.int32)}, [1, 2], program=evil, machine=evil)
    failed = made({}, [], program="x", error=RunError("NP301", evil))
    program = Program(evil, (0x001A,), registers={evil: 3}, outputs=(Output(evil, 0, "scalar"),))
    record = FrameRecord(1, 1, {evil: 1})
    for thing in (result, failed, Chip(program, machine_of()), record):
        shown = page(thing)
        assert "script" not in shown.tags
        assert any("<script>" in text for text in shown.texts)


def test_a_frame_shows_itself() -> None:
    frame = np.arange(64 * 80, dtype=np.uint16).reshape(64, 80).astype(np.uint8)
    np.testing.assert_array_equal(page(Picture(frame)).images[0], frame)
    mask = frame > 100
    np.testing.assert_array_equal(page(Picture(mask)).images[0] > 0, mask)
    with pytest.raises(ValueError, match="float64"):
        Picture(np.zeros((3, 3)))


def test_pillow_is_not_loaded_for_a_run() -> None:
    code = "import sys, npchip.run.chip; assert 'npchip.run.html' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
