"""Every kind of frame source, and every way in which one can be wrong."""

from __future__ import annotations

import io
import os
import pickle
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from npchip.errors import InputError
from npchip.frames import Fit, FrameSource, frames_from_array, frames_from_iterable, open_frames
from npchip.frames.source import MAX_PIXELS

Clip = NDArray[np.uint8]
CLIPS = Path(__file__).parents[1] / "examples" / "clips"
SIZE = (64, 80)


def noise(*shape: int) -> Clip:
    return np.random.default_rng(len(shape)).integers(0, 256, shape, np.uint8)


def load(source: str | Path, fit: Fit | None = None) -> Clip:
    return np.array(list(open_frames(source, *SIZE, fit)))


def refused(source: Any, code: str, *parts: str, fit: Fit | None = None) -> InputError:
    """The error for a source, which is read to its end if it opens."""
    with pytest.raises(InputError) as caught:
        list(frames_from_array(source, *SIZE, fit)) if isinstance(source, np.ndarray) else load(
            source, fit
        )
    error = caught.value
    assert error.code == code, error
    for part in parts:
        assert part in f"{error.message} | {error.hint}"
    return error


def save(path: Path, array: NDArray[Any]) -> Path:
    np.save(path, array)
    return path


# --- arrays and .npy -------------------------------------------------------------------------


@pytest.mark.parametrize("clip", sorted(CLIPS.glob("*.npy")), ids=lambda path: path.stem)
def test_real_clips(clip: Path) -> None:
    wanted = np.load(clip)
    source = open_frames(str(clip), *SIZE)
    assert (source.rows, source.cols) == SIZE
    assert source.count == len(wanted)
    assert (np.array(list(source)) == wanted).all()
    assert (np.concatenate(list(source.batches(7))) == wanted).all()
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
    batch = next(open_frames(path, *SIZE).batches(3))
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
    batch = next(source.batches(4))
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
        ((*SIZE, 3), "NP216", "0.299"),
        ((0, *SIZE), "NP215", "no frames"),
        ((5, 0, 80), "NP216", "no pixels"),
        ((5, 60, 80), "NP217", "expected frames of 64 x 80 (rows x columns), found 60 x 80"),
        ((5, 128, 160), "NP217", "'crop' for its centre or 'resize'"),
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


# --- fitting ---------------------------------------------------------------------------------


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


# --- iterables and the source itself ---------------------------------------------------------


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
                seen.extend(source.batches(8))
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
        batches = list(source.batches(size))
        assert all(batch.dtype == np.uint8 and batch.flags.c_contiguous for batch in batches)
        assert all(0 < len(batch) <= size for batch in batches)
        assert (np.concatenate(batches) == clip).all()


# --- images ----------------------------------------------------------------------------------


def test_a_directory_is_read_in_natural_order(tmp_path: Path) -> None:
    clip = noise(12, *SIZE)
    for number, picture in enumerate(clip):
        Image.fromarray(picture).save(tmp_path / f"{'IMG' if number % 3 else 'img'}{number}.png")
    (tmp_path / "notes.txt").write_text("not a frame")
    (tmp_path / "._img1.png").write_bytes(b"resource fork")
    (tmp_path / "sub.png").mkdir()
    source = open_frames(tmp_path, *SIZE)
    assert source.count == 12
    assert source.cheap_access
    assert (np.array(list(source)) == clip).all()
    assert (source[10] == clip[10]).all()
    assert (load(f"{tmp_path}/*.png") == clip).all()
    assert (load(f"{tmp_path}/*") == clip).all()
    assert (load(str(tmp_path / "[Ii][Mm][Gg]?.png")) == clip[:10]).all()


def test_a_name_with_brackets_is_a_name_first(tmp_path: Path) -> None:
    picture = noise(*SIZE)
    Image.fromarray(picture).save(tmp_path / "a[1].png")
    assert (load(str(tmp_path / "a[1].png")) == picture).all()


@pytest.mark.parametrize("suffix", ["png", "bmp", "tif", "gif", "webp", "pgm", "PNG"])
def test_lossless_formats(tmp_path: Path, suffix: str) -> None:
    picture = noise(*SIZE)
    Image.fromarray(picture).save(tmp_path / f"a.{suffix}", lossless=True)
    assert (load(tmp_path / f"a.{suffix}") == picture).all()


def test_colour_becomes_luma(tmp_path: Path) -> None:
    colours = noise(*SIZE, 3)
    Image.fromarray(colours).save(tmp_path / "a.png")
    luma = colours @ np.array([0.299, 0.587, 0.114])
    assert abs(load(tmp_path / "a.png")[0] - luma).max() <= 0.51
    Image.fromarray(colours).save(tmp_path / "a.jpg", quality=95)
    assert load(tmp_path / "a.jpg").shape == (1, *SIZE)


def test_transparent_is_black(tmp_path: Path) -> None:
    pixels = np.full((*SIZE, 4), 200, np.uint8)
    pixels[:32, :, 3] = 0
    pixels[32:, :, 3] = 255
    pixels[63, :, 3] = 128
    Image.fromarray(pixels).save(tmp_path / "a.png")
    frame = load(tmp_path / "a.png")[0]
    assert (frame[:32] == 0).all()
    assert (frame[32:63] == 200).all()
    assert (abs(frame[63].astype(int) - 100) <= 1).all()


def test_a_photo_is_turned_upright(tmp_path: Path) -> None:
    upright = noise(*SIZE)
    exif = Image.Exif()
    exif[0x0112] = 6  # turn clockwise by 90 degrees to view
    Image.fromarray(np.rot90(upright)).save(tmp_path / "a.png", exif=exif)
    assert (load(tmp_path / "a.png")[0] == upright).all()


@pytest.mark.parametrize("suffix", ["gif", "tif", "png", "webp"])
def test_all_pictures_of_one_file(tmp_path: Path, suffix: str) -> None:
    # A square on black: GIF stores only what changes, so compositing matters.
    clip = np.zeros((6, *SIZE), np.uint8)
    for number, picture in enumerate(clip):
        picture[10:20, 10 * number : 10 * number + 10] = 255
    first, *others = [Image.fromarray(picture) for picture in clip]
    first.save(
        tmp_path / f"a.{suffix}", save_all=True, append_images=others, lossless=True, duration=50
    )
    source = open_frames(tmp_path / f"a.{suffix}", *SIZE)
    assert source.count == 6
    assert (np.array(list(source)) == clip).all()
    assert (source[4] == clip[4]).all()
    assert (source[1] == clip[1]).all()


def test_an_animation_in_a_list_is_refused(tmp_path: Path) -> None:
    first, second = (Image.fromarray(picture) for picture in noise(2, *SIZE))
    first.save(tmp_path / "a.gif", save_all=True, append_images=[second])
    refused(tmp_path, "NP223", "a.gif", "found 2", "by itself")


def test_other_sizes_are_named_with_their_file(tmp_path: Path) -> None:
    Image.fromarray(noise(*SIZE)).save(tmp_path / "1.png")
    Image.fromarray(noise(90, 100)).save(tmp_path / "2.png")
    source = open_frames(tmp_path, *SIZE)
    assert (source[0] == noise(*SIZE)).all()
    refused(tmp_path, "NP217", "2.png", "found 90 x 100")
    assert load(tmp_path, "resize").shape == load(tmp_path, "crop").shape == (2, *SIZE)


def test_the_first_picture_is_checked_at_once(tmp_path: Path) -> None:
    Image.fromarray(noise(90, 100)).save(tmp_path / "1.png")
    with pytest.raises(InputError, match="90 x 100"):
        open_frames(tmp_path, *SIZE)


def test_more_than_8_bits_are_refused(tmp_path: Path) -> None:
    deep = Image.fromarray(np.zeros(SIZE, np.uint16))
    for suffix in ("png", "tif"):
        deep.save(tmp_path / f"a.{suffix}")
        refused(tmp_path / f"a.{suffix}", "NP224", "8 bits per channel")
    for kind, channels in (("P5", 1), ("P6", 3)):
        content = f"{kind} 80 64 65535\n".encode() + bytes(64 * 80 * 2 * channels)
        (tmp_path / "a.ppm").write_bytes(content)
        refused(tmp_path / "a.ppm", "NP224", "8 bits per channel")
    Image.fromarray(np.zeros(SIZE, np.float32)).save(tmp_path / "f.tif")
    refused(tmp_path / "f.tif", "NP224", "pixels of type F")
    (tmp_path / "c.png").write_bytes(png(80, 64, depth=16, colour=2))
    refused(tmp_path / "c.png", "NP224", "found more")


def png(width: int, height: int, depth: int, colour: int) -> bytes:
    """A PNG with a true header and no data worth the name."""
    import struct
    import zlib

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    start = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", start)
        + chunk(b"IDAT", zlib.compress(b""))
        + chunk(b"IEND", b"")
    )


@pytest.mark.parametrize("side", [5793, 10_000, 100_000, 2**31 - 1])
def test_decompression_bombs(tmp_path: Path, side: int) -> None:
    assert side**2 > MAX_PIXELS
    (tmp_path / "a.png").write_bytes(png(side, side, 8, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        refused(tmp_path / "a.png", "NP222", "a.png")


@pytest.mark.parametrize("suffix", ["png", "jpg", "bmp", "tif", "gif", "webp", "pgm"])
def test_cut_images_are_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a.{suffix}"
    Image.fromarray(noise(*SIZE)).save(path)
    whole = path.read_bytes()
    for length in (0, 3, 20, len(whole) // 2, len(whole) * 9 // 10):
        path.write_bytes(whole[:length])
        refused(path, "NP214", path.name)


def test_a_cut_animation_is_refused(tmp_path: Path) -> None:
    first, *others = [Image.fromarray(picture) for picture in noise(4, *SIZE)]
    path = tmp_path / "a.gif"
    first.save(path, save_all=True, append_images=others)
    whole = path.read_bytes()
    for length in range(100, len(whole), 997):
        path.write_bytes(whole[:length])
        refused(path, "NP214")


# --- video -----------------------------------------------------------------------------------


def video(path: Path, clip: Clip, codec: str = "mpeg4", *, audio: bool = False) -> Path:
    with av.open(str(path), "w") as container:
        if audio:
            sound = container.add_stream("pcm_s16le", rate=8000, layout="mono")
            block = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), "s16", "mono")
            block.sample_rate = 8000
            container.mux(sound.encode(block))
            return path
        stream: Any = container.add_stream(codec, rate=25)
        stream.height, stream.width = clip.shape[1:]
        stream.pix_fmt = "yuv420p"
        stream.bit_rate = 4_000_000
        for picture in clip:
            rgb = np.repeat(picture[..., None], 3, axis=2)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(rgb, "rgb24")))
        container.mux(stream.encode())
    return path


def ramps(count: int, rows: int, cols: int) -> Clip:
    """Soft pictures, each brighter than the one before, darker on the left."""
    level = np.linspace(20, 120, cols)[None, None, :] + 10 * np.arange(count)[:, None, None]
    return np.broadcast_to(level, (count, rows, cols)).astype(np.uint8)


@pytest.mark.parametrize("name", ["a.mp4", "a.avi", "a.mkv", "a.mov"])
def test_video(tmp_path: Path, name: str) -> None:
    clip = ramps(9, *SIZE)
    source = open_frames(video(tmp_path / name, clip), *SIZE)
    assert source.count is None
    frames = np.array(list(source))
    assert frames.shape == clip.shape
    assert abs(frames.astype(int) - clip).mean() < 3  # full range, though stored as 16-235
    assert (source[5] == frames[5]).all()
    assert (np.array(list(source)) == frames).all()
    with pytest.raises(IndexError):
        source[9]


def test_video_is_fitted(tmp_path: Path) -> None:
    path = video(tmp_path / "a.mp4", ramps(3, 128, 160))
    refused(path, "NP217", "a.mp4", "128 x 160")
    assert load(path, "crop").shape == load(path, "resize").shape == (3, *SIZE)


def test_video_is_turned_upright(tmp_path: Path) -> None:
    path = video(tmp_path / "a.mp4", ramps(3, 80, 64))
    content = path.read_bytes()
    unit, none = (1 << 16).to_bytes(4, "big"), bytes(4)
    back = (0xFFFF0000).to_bytes(4, "big")
    straight = unit + none * 3 + unit
    clockwise = none + unit + none + back + none  # x' = -y, y' = x
    place = content.index(straight, content.index(b"tkhd"))
    path.write_bytes(content[:place] + clockwise + content[place + len(straight) :])
    frame = load(path)[0].astype(int)
    assert frame.shape == SIZE
    assert (frame[:5].mean() + 50) < frame[-5:].mean()  # the bright right side is now below


def test_missing_pyav_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = video(tmp_path / "a.mp4", ramps(2, *SIZE))
    monkeypatch.setitem(sys.modules, "av", None)
    refused(path, "NP226", "pip install 'npchip[video]'")


@pytest.mark.parametrize("name", ["a.mp4", "a.avi"])
def test_a_cut_video_is_refused(tmp_path: Path, name: str) -> None:
    path = video(tmp_path / name, noise(12, *SIZE))
    whole = path.read_bytes()
    for part in (0, 0.01, 0.3, 0.6, 0.9):
        path.write_bytes(whole[: int(part * len(whole))])
        refused(path, "NP214", name)


def test_sound_alone_is_no_video(tmp_path: Path) -> None:
    refused(video(tmp_path / "a.mkv", noise(1, *SIZE), audio=True), "NP227")


def test_a_video_may_not_name_other_files(tmp_path: Path) -> None:
    video(tmp_path / "other.mp4", ramps(2, *SIZE))
    lists = {
        "hls": f"#EXTM3U\n#EXT-X-VERSION:3\n#EXTINF:10,\n{tmp_path}/other.mp4\n#EXT-X-ENDLIST\n",
        "concat": "ffconcat version 1.0\nfile 'other.mp4'\n",
        "sdp": "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nm=video 9 RTP/AVP 96\n",
    }
    for text in lists.values():
        (tmp_path / "a.mp4").write_text(text)
        refused(tmp_path / "a.mp4", "NP214")


# --- names that lead nowhere ------------------------------------------------------------------


def test_nothing_there(tmp_path: Path) -> None:
    refused(tmp_path / "none.npy", "NP210", "no such file")
    refused(f"{tmp_path}/*.png", "NP210", "no file matches")
    refused("a\0b.npy", "NP210")
    refused("*\0", "NP210")
    refused("", "NP213")  # the present directory, which holds no images
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
    monkeypatch.setattr(Path, "open", denied)
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


# --- anything at all --------------------------------------------------------------------------

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
