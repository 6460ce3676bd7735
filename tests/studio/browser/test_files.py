"""The reader's own files become the frames that ``npchip run`` takes, in both browsers."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from PIL import Image

from npchip.frames import Fit
from tests.studio.browser.driver import Driver
from tests.support.frames import Clip, load, noise, ramps, save, video

pytestmark = pytest.mark.long

NEAR = 4
"""Most that a video's pixels may differ: browsers and libav decode with different roundings."""


class Own(NamedTuple):
    """Files of a reader, the source as npchip opens it, and what both answer to another size."""

    paths: list[Path]
    source: Path
    fit: Fit | None = None
    near: int = 0


def pictures(folder: Path, clip: Clip, suffix: str = "png") -> Own:
    """Write numbered pictures; 2 comes before 10."""
    folder.mkdir()
    for index, picture in enumerate(clip):
        Image.fromarray(picture).save(folder / f"frame{index + 1}.{suffix}")
    return Own(sorted(folder.iterdir()), folder)


def gif(path: Path, clip: Clip) -> Path:
    first, *rest = (Image.fromarray(picture) for picture in clip)
    first.save(path, save_all=True, append_images=rest, duration=40)
    return path


def single(path: Path, fit: Fit | None = None, near: int = 0) -> Own:
    return Own([path], path, fit, near)


def own_files(folder: Path) -> dict[str, Own]:
    """Write a clip of each kind that a reader may have."""
    colours = folder / "colours.png"
    Image.fromarray(noise(64, 80, 3)).save(colours)
    return {
        "array": single(save(folder / "a.npy", noise(5, 64, 80))),
        "one frame": single(save(folder / "one.npy", noise(64, 80))),
        "pictures": pictures(folder / "pictures", noise(11, 64, 80)),
        "colours": single(colours),
        "gif": single(gif(folder / "a.gif", noise(4, 64, 80))),
        "crop": single(save(folder / "crop.npy", noise(3, 90, 121)), "crop"),
        "resize": single(save(folder / "resize.npy", noise(3, 128, 200)), "resize"),
        "resized pictures": pictures(folder / "large", noise(2, 100, 150))._replace(fit="resize"),
        "video": single(video(folder / "a.webm", ramps(12, 64, 80), "libvpx"), near=NEAR),
    }


def test_own_files(driver: Driver, page: str, tmp_path: Path) -> None:
    clips = own_files(tmp_path)
    given = {
        name: {
            "paths": [str(path) for path in own.paths],
            "fit": own.fit.capitalize() if own.fit else None,
        }
        for name, own in clips.items()
    }
    report = driver.run("files: clips become frames", page, tmp_path, clips=given)
    wrong = {name: difference(report["clips"][name], own) for name, own in clips.items()}
    assert not any(wrong.values()), wrong


def difference(found: dict[str, Any], own: Own) -> str:
    """Say how frames of the page differ from those of npchip; empty if they do not."""
    if "error" in found:
        return str(found["error"])
    wanted = load(own.source, own.fit)
    shape = (found["count"], found["rows"], found["cols"])
    if shape != wanted.shape:
        return f"{shape}, not {wanted.shape}"
    frames = np.frombuffer(base64.b64decode(found["data"]), np.uint8).reshape(shape)
    most = int(abs(frames.astype(int) - wanted).max())
    return f"differs by up to {most}" if most > own.near else ""


def test_broken_files(driver: Driver, page: str, tmp_path: Path) -> None:
    whole = save(tmp_path / "whole.npy", noise(2, 64, 80)).read_bytes()
    png = pictures(tmp_path / "p", noise(1, 64, 80)).paths[0].read_bytes()
    film = gif(tmp_path / "g.gif", noise(3, 64, 80)).read_bytes()
    broken = {
        "cut.npy": whole[:-100],
        "floats.npy": save(tmp_path / "f.npy", np.zeros((2, 64, 80))).read_bytes(),
        "empty.npy": b"",
        "cut.png": png[: len(png) // 2],
        "text.png": b"This is no picture.\n",
        "cut.gif": film[: len(film) // 2],
        "text.gif": b"GIF89a, says the text",
        "text.webm": b"no video at all" * 20,
        "empty.mp4": b"",
    }
    folder = tmp_path / "broken"
    folder.mkdir()
    for name, data in broken.items():
        (folder / name).write_bytes(data)
    paths = [str(folder / name) for name in broken]
    flow = "files: broken ones get a message and change nothing"
    said = driver.run(flow, page, tmp_path, broken=paths)["said"]
    unnamed = {name: text for name, text in said.items() if name not in text}
    assert not unnamed, f"messages that do not name the file: {unnamed}"


def test_question_is_taken_back(driver: Driver, page: str, tmp_path: Path) -> None:
    path = save(tmp_path / "large.npy", noise(3, 90, 121))
    flow = "files: the question how to fit can be taken back"
    driver.run(flow, page, tmp_path, paths=[str(path)])


def test_sources(driver: Driver, page: str, tmp_path: Path) -> None:
    source = tmp_path / "mine.s"
    source.write_text("; mine\nframe:  EXPOSE\n        JMP     frame\n", encoding="utf-8")
    broken = tmp_path / "latin.s"
    broken.write_bytes(b"; caf\xe9\n")
    driver.run(
        "files: sources are opened",
        page,
        tmp_path,
        paths=[str(source)],
        text=source.read_text(encoding="utf-8"),
        broken=[str(broken)],
    )
