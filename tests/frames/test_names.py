"""Sources that are nothing of the kind: wrong names, wrong contents, any bytes."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from npchip.base.errors import InputError
from npchip.frames import open_frames
from tests.support.frames import SIZE, load, noise, ramps, refused, save, video

# ---- names that lead nowhere


def test_nothing_there(tmp_path: Path) -> None:
    refused("", "NP210", "name is empty")
    refused(tmp_path / "none.npy", "NP210", "no such file")
    refused(f"{tmp_path}/*.png", "NP210", "no file matches")
    refused("a\0b.npy", "NP210")
    refused("*\0", "NP210")
    (tmp_path / "loop.npy").symlink_to("loop.npy")
    refused(tmp_path / "loop.npy", "NP210", "symbolic link")
    (tmp_path / "gone.npy").symlink_to("nowhere.npy")
    refused(tmp_path / "gone.npy", "NP210", "symbolic link")
    refused("x" * 5000, "NP211", "too long")


def test_a_directory_that_holds_itself(tmp_path: Path) -> None:
    Image.fromarray(noise(*SIZE)).save(tmp_path / "1.png")
    (tmp_path / "2.png").symlink_to(tmp_path)
    (tmp_path / "3.png").symlink_to("3.png")
    assert load(tmp_path).shape == load(f"{tmp_path}/**").shape == (1, *SIZE)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are a Unix matter")
def test_neither_file_nor_directory(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.npy")
    refused(tmp_path / "pipe.npy", "NP211", "neither a file nor a directory")


def test_unreadable_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    for suffix in ("npy", "png", "mp4"):
        (tmp_path / f"a.{suffix}").write_bytes(b"x")
    monkeypatch.setattr("npchip.base.files._open_at_once", denied)
    monkeypatch.setattr(Path, "iterdir", denied)
    for suffix in ("npy", "png", "mp4"):
        refused(tmp_path / f"a.{suffix}", "NP211", "Permission denied")
    refused(tmp_path, "NP211", "Permission denied")


def test_wrong_kinds_of_file(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", clip=noise(2, *SIZE))
    refused(tmp_path / "a.npz", "NP212", "np.load('clip.npz')")
    for name in ("a.txt", "a", "a.py", "a.eps"):
        (tmp_path / name).write_text("hello")
        refused(tmp_path / name, "NP212", name, ".npy")


def test_content_that_contradicts_the_name(tmp_path: Path) -> None:
    save(tmp_path / "a.npy", noise(2, *SIZE)).rename(tmp_path / "a.png")
    refused(tmp_path / "a.png", "NP214", "looks like an .npy array")
    video(tmp_path / "b.mp4", ramps(2, *SIZE)).rename(tmp_path / "b.npy")
    refused(tmp_path / "b.npy", "NP214", "looks like an MP4 or MOV video")
    np.savez(tmp_path / "c.npz", clip=noise(2, *SIZE))
    (tmp_path / "c.npz").rename(tmp_path / "c.npy")
    refused(tmp_path / "c.npy", "NP214", "zip or .npz")
    Image.fromarray(noise(*SIZE)).save(tmp_path / "d.png")
    (tmp_path / "d.png").rename(tmp_path / "d.mp4")
    refused(tmp_path / "d.mp4", "NP214", "looks like a PNG image")


def test_a_directory_without_images(tmp_path: Path) -> None:
    refused(tmp_path, "NP213", "holds no images |")
    for name in ("a.txt", "b.txt", "c.npy", "d.txt"):
        (tmp_path / name).write_text("hello")
    refused(tmp_path, "NP213", "only a.txt, b.txt, c.npy, ...", ".png")
    refused(f"{tmp_path}/*.txt", "NP213", "only a.txt")


# ---- anything at all


SUFFIXES = ("npy", "png", "jpg", "bmp", "tif", "gif", "webp", "ppm", "mp4", "avi", "mkv", "mpg")


@pytest.fixture(scope="module")
def samples(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """A small valid file of every kind."""
    folder = tmp_path_factory.mktemp("samples")
    pictures = [Image.fromarray(picture).convert("RGB") for picture in ramps(3, 16, 16)]
    save(folder / "a.npy", ramps(3, 16, 16))
    for suffix in SUFFIXES[1:8]:
        more: dict[str, Any] = {"save_all": True, "append_images": pictures}
        several = suffix in ("png", "tif", "gif", "webp")
        pictures[0].save(folder / f"a.{suffix}", **(more if several else {}))
    for suffix in SUFFIXES[8:]:
        codec = "mpeg2video" if suffix == "mpg" else "mpeg4"
        video(folder / f"a.{suffix}", ramps(3, 16, 16), codec)
    return {suffix: (folder / f"a.{suffix}").read_bytes() for suffix in SUFFIXES}


@pytest.mark.long
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_random_and_mutated_bytes_never_raise_anything_else(
    samples: dict[str, bytes], tmp_path: Path, suffix: str
) -> None:
    whole = samples[suffix]
    path = tmp_path / f"a.{suffix}"
    edits = st.lists(
        st.tuples(st.integers(0, len(whole) - 1), st.binary(min_size=1, max_size=4)), max_size=8
    )
    head = st.tuples(st.integers(0, min(200, len(whole) - 1)), st.binary(min_size=1, max_size=4))

    @settings(max_examples=40, deadline=None)
    @given(
        st.binary(max_size=300)
        | st.builds(mutate, st.just(whole), edits, st.integers(0, len(whole)) | st.none())
        | st.builds(mutate, st.just(whole), st.lists(head, min_size=1, max_size=3), st.none())
    )
    def attempt(content: bytes) -> None:
        path.write_bytes(content)
        frames = 0
        try:
            for frame in open_frames(path, *SIZE, "resize"):
                assert frame.shape == SIZE
                assert frame.dtype == np.uint8
                frames += 1
                if frames == 20:
                    break
        except InputError as error:
            assert error.code in {f"NP{number}" for number in range(210, 230)}  # noqa: PT017

    attempt()


def mutate(whole: bytes, edits: list[tuple[int, bytes]], length: int | None) -> bytes:
    buffer = io.BytesIO(whole)
    for place, data in edits:
        buffer.seek(place)
        buffer.write(data)
    return buffer.getvalue()[:length]
