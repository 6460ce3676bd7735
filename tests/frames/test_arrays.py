"""Frames from arrays, iterables and .npy files, and how they are fitted."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from npchip.base.errors import InputError
from npchip.frames import Fit, FrameSource, frames_from_array, frames_from_iterable, open_frames
from npchip.frames.feed import SourceFeed
from npchip.frames.fit import fit_frame
from tests.support.frames import CLIPS, SIZE, Clip, load, noise, refused, save

# ---- arrays and .npy


def batches(source: FrameSource, size: int) -> Iterator[Clip]:
    """Yield a source's frames as engines take them."""
    feed = SourceFeed(source, 0)
    taken = 0
    while len(batch := feed.frames(taken, size)):
        yield batch
        taken += len(batch)


@pytest.mark.parametrize("clip", sorted(CLIPS.glob("*.npy")), ids=lambda path: path.stem)
def test_real_clips(clip: Path) -> None:
    wanted = np.load(clip)
    source = open_frames(str(clip), *SIZE)
    assert (source.rows, source.cols) == SIZE
    assert source.count == len(wanted)
    assert (np.array(list(source)) == wanted).all()
    assert (np.concatenate(list(batches(source, 7))) == wanted).all()
    assert (source[source.count - 1] == wanted[-1]).all()


def test_a_clip_is_mapped_not_loaded(tmp_path: Path) -> None:
    first = next(iter(open_frames(save(tmp_path / "a.npy", noise(3, *SIZE)), *SIZE)))
    base: Any = first
    while not isinstance(base, np.memmap):
        base = base.base
    assert not first.flags.writeable


def test_one_picture_is_one_frame(tmp_path: Path) -> None:
    picture = noise(*SIZE)
    assert (load(save(tmp_path / "a.npy", picture)) == picture[None]).all()
    assert (frames_from_array(picture, *SIZE)[0] == picture).all()


@pytest.mark.parametrize("dtype", ["i1", "<i2", ">u2", "<u4", ">i8", "<u8"])
def test_other_integers_are_taken_where_they_fit(tmp_path: Path, dtype: str) -> None:
    clip = noise(3, *SIZE) & 0x7F
    path = save(tmp_path / "a.npy", clip.astype(dtype))
    frames = load(path)
    assert frames.dtype == np.uint8
    assert (frames == clip).all()
    batch = next(batches(open_frames(path, *SIZE), 3))
    assert batch.dtype == np.uint8
    assert (batch == clip).all()


def test_integers_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    clip = noise(3, *SIZE).astype(">u2")
    clip[2, 63, 79] = 4095
    path = save(tmp_path / "a.npy", clip)
    refused(path, "NP220", "a.npy", "found 0 to 4095 (>u2)", "(frames >> 4).astype(np.uint8)")
    clip[2, 63, 79] = 256
    refused(clip, "NP220", "0 to 256")
    signed = noise(1, *SIZE).astype(np.int16)
    signed[0, 0, 0] = -1
    assert refused(signed, "NP220", "found -1 to 255").hint is None


def test_fortran_order_is_read_right(tmp_path: Path) -> None:
    clip = noise(4, *SIZE)
    source = open_frames(save(tmp_path / "a.npy", np.asfortranarray(clip)), *SIZE)
    assert (np.array(list(source)) == clip).all()
    batch = next(batches(source, 4))
    assert batch.flags.c_contiguous
    assert (batch == clip).all()


@pytest.mark.parametrize(
    ("array", "hint"),
    [
        (np.zeros((2, *SIZE), bool), "frames.astype(np.uint8) * 255"),
        (np.full((2, *SIZE), 0.5, np.float32), "(frames * 255).round()"),
        (np.full((2, *SIZE), 99.0), "(frames).round()"),
        (np.full((2, *SIZE), np.nan), "(frames).round()"),
        (np.asfortranarray(np.ones((2, *SIZE), np.float16)), "(frames * 255).round()"),
        (np.zeros((2, *SIZE), complex), "None"),
        (np.zeros((2, *SIZE), "M8[s]"), "None"),
        (np.zeros((2, *SIZE), "U3"), "None"),
        (np.zeros((2, *SIZE), [("a", "u1")]), "None"),
    ],
)
def test_other_types_are_refused(tmp_path: Path, array: NDArray[Any], hint: str) -> None:
    refused(array, "NP219", str(array.dtype), hint)
    refused(save(tmp_path / "a.npy", array), "NP219", hint)


@pytest.mark.parametrize(
    ("shape", "code", "part"),
    [
        ((), "NP216", "found ()"),
        ((80,), "NP216", "found (80,)"),
        ((2, 2, *SIZE), "NP216", "(2, 2, 64, 80)"),
        ((5, *SIZE, 3), "NP216", "0.299"),
        ((5, *SIZE, 1), "NP216", "frames[..., 0]"),
        ((5, 1, *SIZE), "NP216", "frames[:, 0]"),
        ((5, 3, *SIZE), "NP216", "np.tensordot"),
        ((*SIZE, 3), "NP216", "0.299"),
        ((0, *SIZE), "NP215", "no frames"),
        ((5, 0, 80), "NP216", "no pixels"),
        ((5, 60, 80), "NP217", "expected frames of 64 x 80 (rows x columns), found 60 x 80"),
        ((5, 128, 160), "NP217", "crop for their centre, or --fit resize"),
        ((*SIZE, 30), "NP217", "np.moveaxis(frames, -1, 0)"),
        ((5, 80, 64), "NP217", "swapaxes"),
    ],
)
def test_other_shapes_are_refused(
    tmp_path: Path, shape: tuple[int, ...], code: str, part: str
) -> None:
    refused(np.zeros(shape, np.uint8), code, part)
    refused(save(tmp_path / "a.npy", np.zeros(shape, np.uint8)), code, part)


def header(text: str, body: bytes = b"") -> bytes:
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + body


NPY_DAMAGES = {
    "empty": b"",
    "magic only": b"\x93NUMPY",
    "version 9": b"\x93NUMPY\x09\x00\x10\x00" + b" " * 16,
    "text": b"hello",
    "no header": header("spam"),
    "claims more": header("{'descr':'|u1','fortran_order':False,'shape':(9,64,80)}\n", bytes(99)),
    "claims 2**70": header(
        "{'descr':'|u1','fortran_order':False,'shape':(1180591620717411,64,80)}"
    ),
    "negative": header("{'descr':'|u1','fortran_order':False,'shape':(-1,64,80)}", bytes(5120)),
    "negative twice": header("{'descr':'|u1','fortran_order':False,'shape':(-1,-64,80)}"),
    "no shape": header("{'descr':'|u1','fortran_order':False}"),
    "no such type": header("{'descr':'|q9','fortran_order':False,'shape':(1,64,80)}"),
    "deep": header("(" * 5000),
}


@pytest.mark.parametrize("content", NPY_DAMAGES.values(), ids=NPY_DAMAGES.keys())
def test_damaged_npy(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.npy"
    path.write_bytes(content)
    refused(path, "NP214", "a.npy")


def test_a_truncated_clip_says_what_is_missing(tmp_path: Path) -> None:
    path = save(tmp_path / "a.npy", noise(3, *SIZE))
    path.write_bytes(path.read_bytes()[:-1])
    refused(path, "NP214", "shape (3, 64, 80) of uint8 takes 15360 bytes, the file holds 15359")


def test_two_arrays_in_one_file_are_not_read_as_one(tmp_path: Path) -> None:
    """The second array was dropped without a word."""
    path = save(tmp_path / "a.npy", noise(2, *SIZE))
    path.write_bytes(path.read_bytes() * 2)
    refused(path, "NP216", "another behind it", "np.concatenate")
    path.write_bytes(save(path, noise(2, *SIZE)).read_bytes() + bytes(7))
    refused(path, "NP214", "7 bytes follow")


def test_the_newest_format_of_npy_is_read(tmp_path: Path) -> None:
    """Format 3.0 was refused as damaged."""
    clip = noise(2, *SIZE)
    with (tmp_path / "a.npy").open("wb") as file:
        np.lib.format.write_array(file, clip, version=(3, 0))
    assert (load(tmp_path / "a.npy") == clip).all()


@pytest.mark.parametrize("shape", [(*SIZE, 20), (80, 64, 30), (128, 160, 30), (480, 640, 100)])
@pytest.mark.parametrize("fit", ["crop", "resize"])
def test_time_along_the_last_axis_is_not_scaled_away(
    tmp_path: Path, shape: tuple[int, ...], fit: Fit
) -> None:
    """Such an array was read as slivers where a fit was given."""
    path = save(tmp_path / "a.npy", np.zeros(shape, np.uint8))
    refused(path, "NP217", "np.moveaxis", fit=fit)


def test_narrow_frames_are_still_fitted(tmp_path: Path) -> None:
    for shape in ((5, 64, 20), (64, 128, 160), (70, 200, 50)):
        path = save(tmp_path / "a.npy", np.zeros(shape, np.uint8))
        assert load(path, "resize").shape == (shape[0], *SIZE)


class Bomb:
    """Unpickling one ends the test run."""

    def __reduce__(self) -> tuple[Callable[[int], None], tuple[int]]:
        return os._exit, (13,)


def test_nothing_is_unpickled(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.array([Bomb()], object), allow_pickle=True)
    refused(path, "NP221", "never loaded")
    path.write_bytes(pickle.dumps(Bomb()))
    refused(path, "NP221", "never loaded")


# ---- fitting


def exact_average(picture: Clip, size: tuple[int, int]) -> Clip:
    """Area averages by repeating pixels until both grids divide: slow and obvious."""
    (rows, cols), (target_rows, target_cols) = picture.shape, size
    fine = picture.repeat(target_rows, 0).repeat(target_cols, 1).astype(np.int64)
    sums = fine.reshape(target_rows, rows, target_cols, cols).sum((1, 3))
    result: NDArray[np.int64] = (2 * sums + rows * cols) // (2 * rows * cols)
    return result.astype(np.uint8)


@pytest.mark.parametrize(
    "shape", [(12, 20), (13, 21), (11, 25), (6, 77), (5, 9), (1, 5), (300, 7), (600, 10), (5, 6)]
)
def test_resize_averages_areas_exactly(shape: tuple[int, int]) -> None:
    clip = noise(2, *shape)
    source = frames_from_array(clip, 6, 10, "resize")
    for frame, picture in zip(source, clip, strict=True):
        assert (frame == exact_average(picture, (6, 10))).all()


def test_resize_at_drawn_ratios_averages_areas_exactly() -> None:
    """Ratios that divide nothing, in both directions, from strided pictures, beyond one strip."""
    draw = np.random.default_rng(19)
    for _ in range(15):
        rows, cols, target_rows, target_cols = map(int, draw.integers(1, (100, 100, 30, 30)))
        for picture in (noise(rows, cols), noise(cols, rows).T, noise(rows, cols)[::-1, ::-1]):
            found = fit_frame(picture, (target_rows, target_cols), "resize", "a")
            assert (found == exact_average(picture, (target_rows, target_cols))).all()
            assert found.flags.c_contiguous


def test_resize_of_the_longest_sides_is_exact() -> None:
    for picture in (np.full((32768, 3), 255, np.uint8), np.full((2, 32768), 255, np.uint8)):
        assert (fit_frame(picture, (7, 300), "resize", "a") == 255).all()


def test_resize_of_a_whole_multiple_is_the_mean_of_blocks() -> None:
    blocks = np.arange(64 * 80).reshape(SIZE) % 256
    picture = blocks.repeat(3, 0).repeat(2, 1).astype(np.uint8)
    assert (frames_from_array(picture, *SIZE, "resize")[0] == blocks).all()


@pytest.mark.parametrize("shape", [(64, 80), (65, 81), (128, 160), (64, 300)])
def test_crop_takes_the_centre(shape: tuple[int, int]) -> None:
    picture = noise(*shape)
    top, left = (shape[0] - 64) // 2, (shape[1] - 80) // 2
    frame = frames_from_array(picture, *SIZE, "crop")[0]
    assert (frame == picture[top : top + 64, left : left + 80]).all()


def test_what_cannot_be_fitted() -> None:
    refused(noise(2, 63, 800), "NP218", "63 x 800", "64 x 80", "resize", fit="crop")
    refused(noise(1, 1, 32769), "NP222", "32769", fit="resize")
    refused(noise(64, 80, 3), "NP216", "0.299", fit="resize")
    wrong: Any = "stretch"
    refused(noise(*SIZE), "NP225", "crop or resize", "stretch", fit=wrong)


# ---- iterables and the source itself


def test_an_endless_iterable_is_read_one_by_one() -> None:
    taken = 0

    def camera() -> Iterator[Clip]:
        nonlocal taken
        while True:
            taken += 1
            yield np.full(SIZE, taken, np.uint8)

    source = frames_from_iterable(camera(), *SIZE)
    assert source.count is None
    assert taken == 0
    frames = iter(source)
    assert [int(next(frames)[0, 0]) for _ in range(3)] == [1, 2, 3]
    assert taken == 3


def test_items_of_an_iterable_are_checked() -> None:
    good = np.zeros(SIZE, np.uint8)
    items: dict[str, list[Any]] = {
        "NP216": [[[1], [1, 2]], np.zeros((1, *SIZE), np.uint8), 7, None],
        "NP217": [np.zeros((80, 64), np.uint8)],
        "NP219": [np.zeros(SIZE), np.zeros(SIZE, bool)],
        "NP220": [np.full(SIZE, 256)],
        "NP221": [np.full(SIZE, None)],
    }
    for code, wrong in items.items():
        for item in wrong:
            source = frames_from_iterable([good, item], *SIZE)
            assert source.count == 2
            seen: list[Clip] = []
            with pytest.raises(InputError) as caught:
                seen.extend(batches(source, 8))
            with pytest.raises(InputError, match="frame 1"):
                list(source)
            assert caught.value.code == code
            assert [len(batch) for batch in seen] == [1]


def test_errors_of_the_iterable_itself_pass_through() -> None:
    def broken() -> Iterator[Clip]:
        yield np.zeros(SIZE, np.uint8)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        list(frames_from_iterable(broken(), *SIZE))


def test_an_index_outside_is_an_index_error(tmp_path: Path) -> None:
    for number in range(2):
        Image.fromarray(noise(*SIZE)).save(tmp_path / f"{number}.png")
    save(tmp_path / "a.npy", noise(2, *SIZE))
    sources = [
        open_frames(tmp_path, *SIZE),
        open_frames(tmp_path / "a.npy", *SIZE),
        frames_from_iterable([noise(*SIZE)] * 2, *SIZE),
    ]
    for source in sources:
        assert source[1].shape == SIZE
        for index in (-1, 2):
            with pytest.raises(IndexError, match=f"no frame {index}"):
                source[index]


@pytest.mark.parametrize("size", [1, 2, 5, 64])
def test_batches_are_the_frames(size: int) -> None:
    clip = noise(5, *SIZE)
    sources: list[FrameSource] = [
        frames_from_array(clip, *SIZE),
        frames_from_array(clip.astype(np.int32), *SIZE),
        frames_from_array(clip.repeat(2, 1), *SIZE, "resize"),
        frames_from_iterable(clip, *SIZE),
    ]
    for source in sources:
        found = list(batches(source, size))
        assert all(batch.dtype == np.uint8 and batch.flags.c_contiguous for batch in found)
        assert all(0 < len(batch) <= size for batch in found)
        assert (np.concatenate(found) == clip).all()
