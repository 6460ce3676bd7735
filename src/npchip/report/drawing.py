"""Draws scenes: enlarged pixels with smooth lines and marks, and a caption.

Path and prediction are green and red, as in the thesis. Different shapes (dots, a cross, a
rectangle) and dark rims keep the marks distinct without colours.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import cache
from itertools import pairwise, product
from math import ceil, hypot
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw, ImageFont

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import numpy as np
    from numpy.typing import NDArray

Color = tuple[int, int, int]
Place = tuple[float, float]

GREEN: Color = (38, 208, 92)
RED: Color = (255, 66, 56)
CYAN: Color = (64, 200, 255)
RIM: Color = (0, 0, 0)
PAPER: Color = (24, 26, 30)
INK: Color = (238, 238, 238)
FAINT: Color = (160, 164, 170)

_SMOOTH = 2  # scale at which overlays are drawn, before they are scaled down
_FRAME_WIDTH, _TILE_WIDTH = 480, 320
_FRAME_MS, _PAUSE_MS = 120, 1500
_MARGIN = 8
_GAP = 4  # between the panels of a tile
_PANELS = 4  # beside each other
_ROOM = "00000"  # what a value takes at least
_MARK = 16  # smallest box, as the mark of the centre hides smaller ones


@dataclass(frozen=True)
class Mark:
    """An object in a picture.

    Attributes:
        path: its places up to this frame.
        center: its place in this frame, if it is seen.
        predicted: its predicted place.
        window: bounds of the pixels in which it was expected.
        name: written beside it; empty if there is one object only.
    """

    path: list[tuple[int, int]]
    center: tuple[int, int] | None
    predicted: tuple[int, int] | None
    window: tuple[int, int, int, int] | None = None
    name: str = ""


@dataclass(frozen=True)
class Scene:
    """The content of one picture. Points are (row, column), boxes (top, left, bottom, right).

    Attributes:
        background: uint8, shape (rows, columns); None without a clip or a picture.
        title: left part of the caption.
        note: right part of the caption.
        marks: the objects.
        box: bounds of the moving pixels, inclusive.
        shows_path: True if the legend explains paths.
        ahead: how many frames ahead the prediction is that the legend explains; 0 without one.
        shows_window: True if the legend explains windows.
        shows_box: True if the legend explains the box.
        label: name of the background, which panels beside it make necessary.
        panels: names and pixels, uint8 of shape (rows, columns), of what is drawn beside it.
        values: names and values that are written below, in columns.
        lists: the same of lists, each on a line, as far as there is room.
    """

    background: NDArray[np.uint8] | None
    title: str
    note: str
    marks: tuple[Mark, ...] = ()
    box: tuple[int, int, int, int] | None = None
    shows_path: bool = False
    ahead: int = 0
    shows_window: bool = False
    shows_box: bool = False
    label: str = ""
    panels: tuple[tuple[str, NDArray[np.uint8]], ...] = ()
    values: tuple[tuple[str, str], ...] = ()
    lists: tuple[tuple[str, str], ...] = ()


class Pen:
    """Draws lines and marks with a dark rim, in pixels (x, y) of the final picture."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._image = Image.new("RGBA", (size[0] * _SMOOTH, size[1] * _SMOOTH))
        self._draw = ImageDraw.Draw(self._image)

    def line(self, start: Place, end: Place, color: Color, width: float = 2) -> None:
        """Draw a straight line with round ends."""
        for ink, wide in ((RIM, width + 2), (color, width)):
            self._draw.line([*_up(start), *_up(end)], fill=ink, width=round(wide * _SMOOTH))
            for x, y in (start, end):
                self._disc((x, y), wide / 2, ink)

    def dots(self, start: Place, end: Place, color: Color, step: float = 6) -> None:
        """Draw a dashed line."""
        length = hypot(end[0] - start[0], end[1] - start[1])
        count = max(1, ceil(length / step))
        for i in range(0, count, 2):
            a, b = (_between(start, end, min(1.0, j / count)) for j in (i, i + 1))
            self.line(a, b, color, 1.8)

    def disc(self, center: Place, radius: float, color: Color) -> None:
        """Draw a filled circle."""
        self._disc(center, radius + 1, RIM)
        self._disc(center, radius, color)

    def cross(self, center: Place, radius: float, color: Color) -> None:
        """Draw a diagonal cross."""
        x, y = center
        arms = [((x - radius, y - radius), (x + radius, y + radius))]
        arms.append(((x - radius, y + radius), (x + radius, y - radius)))
        for ink, width in ((RIM, 5.0), (color, 2.6)):
            for start, end in arms:
                self._draw.line([*_up(start), *_up(end)], fill=ink, width=round(width * _SMOOTH))

    def box(self, corners: tuple[float, float, float, float], color: Color) -> None:
        """Draw an empty rectangle: left, top, right, bottom."""
        for ink, outset, width in ((RIM, 1.0, 3.5), (color, 0.0, 1.5)):
            left, top, right, bottom = corners
            edge = (left - outset, top - outset, right + outset, bottom + outset)
            self._draw.rectangle(
                [value * _SMOOTH for value in edge], outline=ink, width=round(width * _SMOOTH)
            )

    def text(self, beside: Place, text: str) -> None:
        """Write a short text to the upper right of a point."""
        x, y = _up((beside[0] + 7, beside[1] - 7))
        font = _font(14 * _SMOOTH)
        self._draw.text((x, y), text, INK, font, "lb", stroke_width=_SMOOTH, stroke_fill=RIM)

    def put_on(self, image: Image.Image, at: tuple[int, int]) -> None:
        """Paste the drawing onto `image`, with its upper left corner at `at`."""
        size = (self._image.width // _SMOOTH, self._image.height // _SMOOTH)
        small = self._image.resize(size, Image.Resampling.BOX)
        image.paste(small, at, small)

    def _disc(self, center: Place, radius: float, color: Color) -> None:
        x, y = _up(center)
        r = radius * _SMOOTH
        self._draw.ellipse([x - r, y - r, x + r, y + r], fill=color)


def animation(scenes: Iterable[Scene]) -> bytes:
    """Return an endless GIF of all scenes, with a pause after the last one."""
    images: list[Image.Image] = []
    for scene in scenes:
        tile = _tile(scene, _FRAME_WIDTH if _across(scene) == 1 else _TILE_WIDTH)
        legend = _legend(scene, tile.width)
        whole = _stack([tile, *([legend] if legend else [])])
        images.append(whole.quantize(palette=_palette(), dither=Image.Dither.NONE))
    buffer = io.BytesIO()
    images[0].save(
        buffer,
        "GIF",
        save_all=True,
        append_images=images[1:],
        duration=[_FRAME_MS] * (len(images) - 1) + [_PAUSE_MS],
        loop=0,
    )
    return buffer.getvalue()


def sheet(scenes: list[Scene]) -> bytes:
    """Return a PNG of all scenes in rows of about four panels, the legend below."""
    across = _across(scenes[0])
    columns = ceil(len(scenes) / ceil(len(scenes) * across / _PANELS))
    rows = ceil(len(scenes) / columns)
    width = _TILE_WIDTH if columns * across > 1 else _FRAME_WIDTH
    tiles = [_tile(scene, width) for scene in scenes]
    width, height = tiles[0].size
    size = (columns * (width + _MARGIN) + _MARGIN, rows * (height + _MARGIN) + _MARGIN)
    whole = Image.new("RGB", size, PAPER)
    for index, tile in enumerate(tiles):
        row, column = divmod(index, columns)
        whole.paste(
            tile, (_MARGIN + column * (width + _MARGIN), _MARGIN + row * (height + _MARGIN))
        )
    legend = _legend(scenes[0], whole.width)
    buffer = io.BytesIO()
    _stack([whole, legend] if legend else [whole]).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _across(scene: Scene) -> int:
    """Return the number of panels beside each other."""
    return max(1, min(_PANELS, len(scene.panels) + (scene.background is not None)))


def _tile(scene: Scene, width: int) -> Image.Image:
    """Draw background and panels, each of about `width`, with the caption and the values."""
    parts = []
    wide = width
    if scene.background is not None:
        picture = _picture(scene, scene.background, _scale(scene.background, width))
        wide = picture.width
        parts.append(_stack([picture, _strip(scene.label, wide)]) if scene.panels else picture)
    for label, pixels in scene.panels:
        rows, cols = pixels.shape
        scale = _scale(pixels, wide)
        size = (cols * scale, rows * scale)
        panel = Image.fromarray(pixels).resize(size, Image.Resampling.NEAREST).convert("RGB")
        parts.append(_stack([panel, _strip(label, panel.width)]))
    across = _across(scene)
    high = max((part.height for part in parts), default=0)
    wide = max((part.width for part in parts), default=width)
    size = (across * (wide + _GAP) - _GAP, ceil(len(parts) / across) * high)
    grid = Image.new("RGB", size, PAPER)
    for index, part in enumerate(parts):
        row, column = divmod(index, across)
        grid.paste(part, (column * (wide + _GAP), row * high))
    groups = [scene.values, *((item,) for item in scene.lists)]
    values = [_values(group, size[0]) for group in groups if group]
    return _stack([grid, _caption(scene, size[0]), *values])


def _strip(text: str, width: int) -> Image.Image:
    image = Image.new("RGB", (width, 22), PAPER)
    ImageDraw.Draw(image).text((6, 10), text, fill=FAINT, font=_font(14), anchor="lm")
    return image


def _values(values: Sequence[tuple[str, str]], width: int) -> Image.Image:
    """Write values in columns whose places depend on the names only."""
    font = _font(14)
    longest = max(font.getlength(f"{name} {_ROOM}") for name, _ in values)
    columns = max(1, min(len(values), width // ceil(longest + 12)))
    slot = width // columns
    image = Image.new("RGB", (width, 20 * ceil(len(values) / columns) + 6), PAPER)
    for index, (name, value) in enumerate(values):
        row, column = divmod(index, columns)
        strip = Image.new("RGB", (slot, 20), PAPER)
        draw = ImageDraw.Draw(strip)
        draw.text((6, 10), name, fill=FAINT, font=font, anchor="lm")
        at = 6 + font.getlength(f"{name} ")
        draw.text((at, 10), value, fill=INK, font=font, anchor="lm")
        image.paste(strip, (column * slot, row * 20))
    return image


def _picture(scene: Scene, background: NDArray[np.uint8], scale: int) -> Image.Image:
    rows, cols = background.shape
    size = (cols * scale, rows * scale)
    image = Image.fromarray(background).resize(size, Image.Resampling.NEAREST).convert("RGB")
    pen = Pen(size)

    def place(point: tuple[int, int]) -> Place:
        return (point[1] + 0.5) * scale, (point[0] + 0.5) * scale

    for mark in scene.marks:
        path = [place(point) for point in mark.path]
        for start, end in pairwise(path):
            pen.line(start, end, GREEN)
        for point in path:
            pen.disc(point, 2.2, GREEN)
    for box in (scene.box, *(mark.window for mark in scene.marks)):
        if box:
            top, left, bottom, right = box
            x, width = _at_least(_MARK, left * scale, (right + 1) * scale)
            y, height = _at_least(_MARK, top * scale, (bottom + 1) * scale)
            pen.box((x, y, x + width, y + height), CYAN)
    for mark in scene.marks:
        if mark.center and mark.predicted:
            pen.dots(place(mark.center), place(mark.predicted), RED)
        if mark.predicted:
            pen.cross(place(mark.predicted), 6, RED)
        if mark.center:
            pen.disc(place(mark.center), 3.6, GREEN)
            pen.text(place(mark.center), mark.name)
    pen.put_on(image, (0, 0))
    return image


def _caption(scene: Scene, width: int) -> Image.Image:
    image = Image.new("RGB", (width, 26), PAPER)
    draw = ImageDraw.Draw(image)
    draw.text((6, 13), scene.title, fill=INK, font=_font(16), anchor="lm")
    draw.text((width - 6, 13), scene.note, fill=FAINT, font=_font(14), anchor="rm")
    return image


def _legend(scene: Scene, width: int) -> Image.Image | None:
    """Return a strip that explains the marks of a program; None if it uses none."""
    items = []
    if scene.shows_path:
        items.append(("path", "past path"))
    if scene.ahead:
        when = "next" if scene.ahead == 1 else f"{scene.ahead} frames ahead"
        items.append(("prediction", f"predicted {when}"))
    if scene.shows_window:
        items.append(("box", "expected here"))
    if scene.shows_box:
        items.append(("box", "moving pixels"))
    if not items:
        return None
    image = Image.new("RGB", (width, 26), PAPER)
    draw, pen = ImageDraw.Draw(image), Pen((width, 26))
    x, y = 6.0, 12.0
    for kind, text in items:
        if kind == "path":
            pen.line((x + 4, y), (x + 24, y), GREEN)
            pen.disc((x + 4, y), 2.2, GREEN)
            pen.disc((x + 24, y), 3.6, GREEN)
        elif kind == "prediction":
            pen.dots((x + 2, y), (x + 20, y), RED)
            pen.cross((x + 24, y), 6, RED)
        else:
            pen.box((x + 6, y - 6, x + 28, y + 6), CYAN)
        draw.text((x + 36, y), text, fill=INK, font=_font(14), anchor="lm")
        x += 36 + draw.textlength(text, font=_font(14)) + 16
    pen.put_on(image, (0, 0))
    return image


def _stack(images: list[Image.Image]) -> Image.Image:
    whole = Image.new("RGB", (images[0].width, sum(image.height for image in images)), PAPER)
    y = 0
    for image in images:
        whole.paste(image, (0, y))
        y += image.height
    return whole


def _scale(pixels: NDArray[np.uint8], width: int) -> int:
    return max(1, width // int(pixels.shape[1]))


def _at_least(length: float, start: float, end: float) -> tuple[float, float]:
    """Return (start, length) of an interval, widened about its middle if it is too short."""
    spare = max(0.0, length - (end - start))
    return start - spare / 2, end - start + spare


@cache
def _palette() -> Image.Image:
    """Return a palette of greys, mixtures of each colour with greys, and the caption's paper."""
    greys = [(value, value, value) for value in range(0, 256, 4)] + [(255, 255, 255)]
    mixtures = [
        tuple(round(ink * part + grey * (1 - part)) for ink in color)
        for color, part, grey in product(
            (GREEN, RED, CYAN), (1.0, 0.8, 0.6, 0.4, 0.2), range(0, 256, 23)
        )
    ]
    image = Image.new("P", (1, 1))
    image.putpalette([channel for color in [*greys, *mixtures, PAPER] for channel in color])
    return image


@cache
def _font(size: int) -> ImageFont.ImageFont | ImageFont.FreeTypeFont:
    return ImageFont.load_default(size)


def _up(place: Place) -> Place:
    return place[0] * _SMOOTH, place[1] * _SMOOTH


def _between(start: Place, end: Place, part: float) -> Place:
    return start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part
