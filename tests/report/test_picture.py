"""Pictures of a run: what is drawn where, and files that viewers can open."""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageSequence

from npchip import Chip, assemble
from npchip.base.errors import InputError
from npchip.program.model import Output, Program
from npchip.report import picture
from npchip.report.drawing import CYAN, GREEN, RED, Color, Scene
from npchip.report.picture import (
    check_suffix,
    render,
    telling_frames,
)
from npchip.run.result import RunResult
from tests.support.clips import bundled_clips
from tests.support.results import IMAGING, TRAJECTORY, imaged, made, tracked

SCALE = 6


def moving_dot(frames: int = 5) -> NDArray[np.uint8]:
    """A bright dot that moves 10 columns to the right in every frame of row 20."""
    clip = np.zeros((frames, 64, 80), np.uint8)
    for k in range(frames):
        clip[k, 20, 10 * k + 10] = 255
    return clip


def drawn(result: RunResult, program: Program, clip: NDArray[np.uint8], path: Path) -> bytes:
    render(result, program, list(clip), path)
    return path.read_bytes()


def gif_frames(data: bytes) -> list[NDArray[np.uint8]]:
    image = Image.open(io.BytesIO(data))
    return [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)]


def looks_like(pixel: NDArray[np.uint8], color: Color) -> bool:
    return bool(np.abs(pixel.astype(int) - color).max() < 40)


def test_it_is_told_how_far_the_drawing_of_a_gif_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def animation(scenes: Iterable[Scene]) -> bytes:
        for scene in scenes:
            told.append(scene.title)
        return b""

    clip, told = moving_dot(3), list[object]()
    monkeypatch.setattr(picture, "animation", animation)
    render(tracked(clip), TRAJECTORY, list(clip), tmp_path / "a.gif", told.append)
    assert told == [0, "frame 0", 1, "frame 1", 2, "frame 2"]


def test_gif_shows_every_frame_with_its_marks(tmp_path: Path) -> None:
    clip = moving_dot()
    frames = gif_frames(drawn(tracked(clip), TRAJECTORY, clip, tmp_path / "a.gif"))
    assert len(frames) == 5
    last = frames[-1]
    assert last.shape[1] == 80 * SCALE
    # The moving pixels are columns 40 and 50, so the centre is 45, and 55 is expected next.
    y = 20 * SCALE + SCALE // 2
    assert looks_like(last[y, 45 * SCALE + 3], GREEN)
    assert looks_like(last[y, 20 * SCALE + 3], GREEN), "path"
    assert looks_like(last[y, 55 * SCALE + 3], RED)
    cyan = np.argwhere(np.abs(last[: 64 * SCALE].astype(int) - CYAN).max(axis=2) < 30)
    assert abs(cyan[:, 1].min() - 40 * SCALE) <= 2
    assert abs(cyan[:, 1].max() - 51 * SCALE) <= 2


def test_first_frame_has_no_marks(tmp_path: Path) -> None:
    clip = moving_dot()
    first = gif_frames(drawn(tracked(clip), TRAJECTORY, clip, tmp_path / "a.gif"))[0]
    image = first[: 64 * SCALE]
    assert (image.max(axis=2) == image.min(axis=2)).all()
    assert image[20 * SCALE + 3, 10 * SCALE + 3].min() > 240


@pytest.mark.long
def test_gif_plays_for_ever_at_a_steady_pace_and_is_small(tmp_path: Path) -> None:
    clip = bundled_clips()["mouse_run"]
    data = drawn(tracked(clip), TRAJECTORY, clip, tmp_path / "a.gif")
    image = Image.open(io.BytesIO(data))
    assert image.info["loop"] == 0
    assert image.info["duration"] == 120
    assert len(data) < 1_000_000


def test_sheet_of_up_to_twelve_frames(tmp_path: Path) -> None:
    clip = bundled_clips()["mouse_run"]
    data = drawn(tracked(clip), TRAJECTORY, clip, tmp_path / "a.PNG")
    width, height = Image.open(io.BytesIO(data)).size
    assert 1280 < width < 1340
    assert height > 3 * 256


def test_telling_frames_are_spread_over_the_valid_ones() -> None:
    result = tracked(bundled_clips()["coin_slide"])
    assert telling_frames(result) == [5, 6, 7, 8, 9, 10, 11]
    assert telling_frames(result, 3) == [5, 8, 11]
    still = tracked(np.zeros((30, 64, 80), np.uint8))
    assert len(telling_frames(still)) == 12
    assert telling_frames(still)[::11] == [0, 29]


def test_a_picture_output_stands_beside_the_clip_as_it_is(tmp_path: Path) -> None:
    clip = moving_dot(2)
    pictures = 100 - clip // 4
    data = drawn(imaged(pictures), IMAGING, clip, tmp_path / "a.png")
    image = np.asarray(Image.open(io.BytesIO(data)).convert("L"))
    assert (image[100, 100], image[100, 100 + 324]) == (0, 100)


def test_picture_output_needs_no_clip(tmp_path: Path) -> None:
    pictures = np.ma.masked_array(np.full((2, 64, 80), 9, np.uint8))
    pictures[1] = np.ma.masked
    render(made({"picture": pictures}, [1, 1]), IMAGING, [], tmp_path / "a.gif")
    assert len(gif_frames((tmp_path / "a.gif").read_bytes())) == 2


@pytest.mark.parametrize("shape", [(8, 8), (128, 160), (256, 256), (8, 2048)])
def test_other_geometries(tmp_path: Path, shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(1)
    clip = rng.integers(256, size=(3, *shape)).astype(np.uint8)
    for suffix in ("png", "gif"):
        drawn(tracked(clip), TRAJECTORY, clip, tmp_path / f"a.{suffix}")


def test_path_alone_and_no_threshold(tmp_path: Path) -> None:
    clip = moving_dot()
    whole = tracked(clip)
    names = ("center_row", "center_col")
    result = replace(whole, outputs={name: whole.outputs[name] for name in names})
    outputs = tuple(Output(name, port, "scalar") for port, name in enumerate(names))
    program = Program("centre", (0,), outputs=outputs)
    drawn(result, program, clip, tmp_path / "a.gif")


def test_other_suffix_is_refused() -> None:
    with pytest.raises(InputError, match=r"\.png or \.gif.*NP247"):
        check_suffix(Path("film.mp4"))
    check_suffix(Path("film.GIF"))


def test_nothing_to_draw_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="NP249"):
        render(imaged(np.zeros((0, 64, 80), np.uint8)), IMAGING, [], tmp_path / "a.png")


def test_planes_and_numbers_of_any_program_are_drawn(tmp_path: Path) -> None:
    sums = np.zeros((2, 8, 10), np.uint8)
    sums[0, 2, 3], sums[1, 7, 9] = 4, 8  # the greatest of the run is white
    outputs = {"sums": sums, "count": np.array([7, 9], np.int32), "places": [[1, 2], []]}
    result = made(outputs, [5, 6])
    program = Program("sums", (0,), outputs=(Output("sums", 0, "plane"),))
    clip = np.full((2, 64, 80), 50, np.uint8)
    side = 32  # of an NP: a panel is 320 wide
    for k, whole in enumerate(gif_frames(drawn(result, program, clip, tmp_path / "a.gif"))):
        panel = whole[: 8 * side, 320 + 4 :]
        found = panel[side // 2 :: side, side // 2 :: side, 0][:8, :10]
        assert np.abs(found.astype(int) - sums[k].astype(int) * 255 // 8).max() <= 3
        assert np.abs(whole[100, :320].astype(int) - 50).max() <= 3, "the clip is beside it"
    texts = [gif[-45:].tobytes() for gif in gif_frames((tmp_path / "a.gif").read_bytes())]
    assert texts[0] != texts[1], "numbers are written below"
    without = drawn(result, program, clip[:0], tmp_path / "b.png")
    assert Image.open(io.BytesIO(without)).width == 2 * (320 + 8) + 8, "a tile for each frame"


def test_what_a_program_without_frames_sends_is_drawn(tmp_path: Path) -> None:
    source = tmp_path / "once.s"
    sends = "".join(f" OUT {port}, r0\n" for port in range(3))
    outputs = ".output a, 0, plane\n.output s, 1, scalar\n.output l, 2, list\n"
    source.write_text(f"{outputs}{sends} HALT\n")
    program = assemble(source)
    for name in ("a.png", "a.gif"):
        render(Chip(program).run(), program, [], tmp_path / name)
        with Image.open(tmp_path / name) as image:
            assert image.width >= 480
