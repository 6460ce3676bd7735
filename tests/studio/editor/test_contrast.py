"""Colours of the editor can be read in both themes."""

from __future__ import annotations

import re

from tests.support.page_code import PAGE


def test_colours_have_contrast_in_both_themes() -> None:
    theme = (PAGE / "shell" / "theme.css").read_text()
    own = (PAGE / "editor" / "colours.css").read_text()
    for mark in (r":root \{", r':root\[data-theme="dark"\] \{'):
        panel = values(theme, mark)
        colours = values(
            own,
            r"\.editor \{\n  --editor-comment"
            if "dark" not in mark
            else mark[:-3] + r" \.editor \{",
        )
        assert len(colours) == 8
        for name, colour in colours.items():
            for share, tint in ((0, "--panel"), (0.55, "--raised"), (0.22, "--good")):
                ground = mixed(panel[tint], panel["--panel"], share)
                assert contrast(rgb(colour), ground) >= 4.5, (mark, name, tint)


def values(css: str, start: str) -> dict[str, str]:
    match = re.search(start, css)
    assert match, start
    block = css[css.index("{", match.start()) : css.index("}", match.end())]
    return dict(re.findall(r"(--[\w-]+): (#[0-9a-f]{6});", block))


def rgb(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))


def mixed(over: str, under: str, share: float) -> tuple[float, ...]:
    return tuple(a * share + b * (1 - share) for a, b in zip(rgb(over), rgb(under), strict=True))


def contrast(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    dark, light = sorted(map(luminance, (one, other)))
    return (light + 0.05) / (dark + 0.05)


def luminance(colour: tuple[float, ...]) -> float:
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return sum(c * weight for c, weight in zip(linear, (0.2126, 0.7152, 0.0722), strict=True))
