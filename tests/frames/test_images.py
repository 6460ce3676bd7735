"""Frames from images."""

from __future__ import annotations

import re
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from npchip.base.errors import InputError
from npchip.frames import open_frames
from npchip.frames.order import in_order
from npchip.frames.source import MAX_PIXELS
from tests.support.frames import SIZE, load, noise, refused, video


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


def test_brackets_in_the_name_of_a_folder(tmp_path: Path) -> None:
    """A pattern with such a folder matched nothing, without a hint."""
    for number, folder in enumerate(("b[1]", "b1")):
        (tmp_path / folder).mkdir()
        Image.fromarray(np.full(SIZE, number, np.uint8)).save(tmp_path / folder / "0.png")
        if number == 0:
            assert (load(f"{tmp_path}/b[1]/*.png") == 0).all()
    refused(f"{tmp_path}/b[1]/*.png", "NP210", "b1/0.png as a pattern", "b[[]1]/*.png")
    assert (load(f"{tmp_path}/b[[]1]/*.png") == 0).all()


@pytest.mark.parametrize(
    "names",
    [
        "img_-10 img_-2 img_-1 img_0 img_1 img_10",
        "-2 -1 0 1",
        "t-2 t-1 t0 t1",
        "frame--1 frame-0 frame-1",
        "frame-1 frame-2 frame-10",
        "shot 2024-01-02 shot 2024-01-10 shot 2024-02-01",
        "2024-01-02_9-59-58 2024-01-02_10-00-00",
        "0.25 0.5 1.0 1.25",
        "x_-0.5 x_-0.25 x_0.0",
        "1700000000.123457 1700000000.2 1700000000.2000001 1700000001.5",
        "shot1.1 shot1.2 shot1.9 shot1.10 shot1.11",
        "a.1 a.2 a.10",
        "1.2.9 1.2.10 1.10.1",
    ],
)
def test_names_stand_in_the_order_of_their_numbers(names: str) -> None:
    """Numbers below zero were read backwards, fractions as numbers of their own."""
    wanted = [Path(f"dir-1/{name}.png") for name in re.findall(r"shot \S+|\S+", names)]
    assert in_order(wanted[::-1]) == wanted


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


def gif(*parts: tuple[tuple[int, int, int, int], int, int, int | None]) -> bytes:
    """A GIF whose parts have a place, a colour, a disposal, and a transparent colour.

    Parts with an odd disposal have a palette of their own.
    """
    common = bytes([0, 0, 0, 80, 80, 80, 160, 160, 160, 240, 240, 240])
    content = b"GIF89a" + struct.pack("<2HBBB", 80, 64, 0x81, 0, 0) + common
    for number, (place, colour, disposal, hole) in enumerate(parts):
        flags = disposal << 2 | (hole is not None)
        content += b"!\xf9\x04" + struct.pack("<BHBB", flags, 10, hole or 0, 0)
        own = bytes([0, 0, 0, 200, 10, 10, 10, 200, 10, 10, 10, 200]) if number % 2 else b""
        content += b"," + struct.pack("<4HB", *place, 0x81 if own else 0) + own
        pixels = place[2] * place[3]
        codes = [code for at in range(pixels) for code in ([4] if at % 2 == 0 else []) + [colour]]
        bits = sum(code << 3 * at for at, code in enumerate([*codes, 5]))
        data = bits.to_bytes(len(codes) * 3 // 8 + 2, "little")
        content += b"\x02"
        for at in range(0, len(data), 255):
            content += bytes([len(data[at : at + 255])]) + data[at : at + 255]
        content += b"\0"
    return content + b";"


ANIMATION = gif(
    ((0, 0, 80, 64), 1, 1, None),
    ((5, 5, 40, 30), 2, 2, None),
    ((20, 20, 40, 30), 3, 3, None),
    ((30, 10, 30, 50), 1, 1, 1),
    ((60, 50, 20, 14), 2, 0, 0),
)


def test_parts_of_a_gif_are_composed_as_another_decoder_does(tmp_path: Path) -> None:
    """Areas disposed of were the background's colour; palettes of parts were called damage."""
    import av

    (tmp_path / "a.gif").write_bytes(ANIMATION)
    with av.open(str(tmp_path / "a.gif"), options={"ignore_loop": "1"}) as container:
        frames = [frame.to_ndarray(format="rgba") for frame in container.decode(video=0)]
    wanted = [
        (f[..., :3] @ [0.299, 0.587, 0.114] * (f[..., 3] > 0)).round().astype(int) for f in frames
    ]
    found = load(tmp_path / "a.gif")
    assert len(found) == len(wanted) == 5
    for picture, other in zip(found, wanted, strict=True):
        assert abs(picture - other).max() <= 1


def test_bytes_behind_the_end_of_a_gif_are_left_out(tmp_path: Path) -> None:
    """They were taken for a file cut short."""
    (tmp_path / "a.gif").write_bytes(ANIMATION + b"copied by a camera")
    assert len(load(tmp_path / "a.gif")) == 5


def test_the_default_image_of_an_animation_is_no_frame(tmp_path: Path) -> None:
    """It was shown as the first frame."""
    first, *others = (Image.fromarray(picture) for picture in noise(4, *SIZE))
    first.save(tmp_path / "a.png", save_all=True, append_images=others, default_image=True)
    assert (load(tmp_path / "a.png") == noise(4, *SIZE)[1:]).all()


@pytest.mark.parametrize("kind", ["P4", "P5", "P6", "mixed"])
def test_several_pictures_in_a_portable_map(tmp_path: Path, kind: str) -> None:
    """All but the first were dropped without a word."""
    content, wanted = b"", []
    for each in ("P5", "P6", "P4") if kind == "mixed" else (kind,) * 3:
        picture = noise(*SIZE)
        body = {"P4": np.packbits(picture < 128, 1), "P6": picture.repeat(3, 1)}.get(each, picture)
        wanted.append((picture >= 128) * 255 if each == "P4" else picture)
        content += f"{each}\n# a comment\n80 64\n{'' if each == 'P4' else '255 '}".encode()[:-1]
        content += b"\n" + body.tobytes()
    (tmp_path / "a.pnm").write_bytes(content + b"\n")
    assert (load(tmp_path / "a.pnm") == wanted).all()
    (tmp_path / "a.pnm").write_bytes(content[:-9])
    refused(tmp_path / "a.pnm", "NP214", "frame 2")
    (tmp_path / "a.pnm").write_bytes(content + b"junk")
    refused(tmp_path / "a.pnm", "NP214", "frame 3")


def test_a_bmp_without_any_opaque_pixel_is_shown_as_viewers_do(tmp_path: Path) -> None:
    """Its unused byte was taken for transparency: all black."""
    pixels = np.full((*SIZE, 4), 90, np.uint8)
    for alpha, wanted in ((0, (90, 90)), (255, (90, 0))):
        pixels[..., 3] = alpha
        pixels[:, 40:, 3] = 0
        masks = struct.pack("<4I", 0xFF0000, 0xFF00, 0xFF, 0xFF000000)
        head = struct.pack("<IiiHHIIiiII", 108, 80, -64, 1, 32, 3, 0, 0, 0, 0, 0) + masks
        head += bytes(108 - len(head))
        start = b"BM" + struct.pack("<IHHI", 14 + 108 + pixels.size, 0, 0, 14 + 108)
        (tmp_path / "a.bmp").write_bytes(start + head + pixels.tobytes())
        frame = load(tmp_path / "a.bmp")[0]
        assert (frame[:, :40] == wanted[0]).all()
        assert (frame[:, 40:] == wanted[1]).all()


def test_what_a_tiff_states_is_heeded(tmp_path: Path) -> None:
    """Signed bytes, 10 bits, planes of 16 bits, and stacks in one directory were read wrongly."""
    import tifffile

    path = tmp_path / "a.tif"
    clip = noise(3, *SIZE)
    tifffile.imwrite(path, clip[0].astype(np.int8), photometric="minisblack")
    refused(path, "NP224", "signed")
    tifffile.imwrite(path, np.zeros((3, *SIZE), np.uint16), photometric="rgb", planarconfig=2)
    refused(path, "NP224", "found more")
    tifffile.imwrite(path, clip[0].astype(np.uint16))
    sixteen, ten = (struct.pack("<HHIHH", 258, 3, 1, bits, 0) for bits in (16, 10))
    path.write_bytes(path.read_bytes().replace(sixteen, ten))
    refused(path, "NP224", "8 bits per channel")
    tifffile.imwrite(path, clip, imagej=True)
    if pages(path) == 3:
        assert (load(path) == clip).all()
    else:
        refused(path, "NP216", "np.save")
    tifffile.imwrite(path, clip, volumetric=True, photometric="minisblack")
    refused(path, "NP216", "np.save")
    tifffile.imwrite(path, noise(3, *SIZE), photometric="rgb", planarconfig=2)
    luma = np.moveaxis(noise(3, *SIZE), 0, -1) @ [0.299, 0.587, 0.114]
    assert abs(load(path)[0] - luma).max() <= 0.51


def pages(path: Path) -> int:
    import tifffile

    with tifffile.TiffFile(path) as tiff:
        return len(tiff.pages)


@pytest.mark.parametrize("marked", [0, 1])
def test_pages_of_reduced_resolution_are_no_frames(tmp_path: Path, marked: int) -> None:
    """They were read as further frames where a fit was given."""
    import tifffile

    picture = noise(128, 160)
    with tifffile.TiffWriter(tmp_path / "a.tif") as file:
        for step in (1, 2, 4):
            file.write(picture[::step, ::step], subfiletype=marked if step > 1 else 0)
    assert len(load(tmp_path / "a.tif", "resize")) == 1


def test_a_tiff_without_its_last_directory_is_refused(tmp_path: Path) -> None:
    """A frame was shown a second time in place of the missing one."""
    path = tmp_path / "a.tif"
    first, *others = [Image.fromarray(picture) for picture in noise(4, *SIZE)]
    first.save(path, save_all=True, append_images=others, compression="tiff_lzw")
    assert len(load(path)) == 4
    whole = path.read_bytes()
    for cut in (40, 150, 300):
        path.write_bytes(whole[:-cut])
        refused(path, "NP214", "a.tif")


def test_a_wrong_checksum_of_a_png_is_damage(tmp_path: Path) -> None:
    """Wrong pixels were shown without a word."""
    path = tmp_path / "a.png"
    Image.fromarray(noise(*SIZE)).save(path, compress_level=0)
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    refused(path, "NP214", "IDAT")


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


@pytest.mark.parametrize(
    "name", ["1.png", "1.gif", "1.ppm", "1.tif", "1.bmp", "1.webp", "1.npy", "1.avi", "", "*.png"]
)
def test_the_first_picture_of_any_source_is_checked_at_once(tmp_path: Path, name: str) -> None:
    """A size that does not fit is found before the run, not by its first frame."""
    file = tmp_path / (name if name and "*" not in name else "1.png")
    if file.suffix == ".npy":
        np.save(file, noise(2, 90, 100))
    elif file.suffix == ".avi":
        video(file, noise(2, 90, 100))
    else:
        Image.fromarray(noise(90, 100)).save(file)
    with pytest.raises(InputError, match=r"90 x 100|90, 100"):
        open_frames(tmp_path / name if name else tmp_path, *SIZE)


@pytest.mark.parametrize("most", [1, 15, 100, 254, 255])
@pytest.mark.parametrize("kind", ["P2", "P3", "P5", "P6"])
def test_greatest_values_up_to_255_are_white(tmp_path: Path, kind: str, most: int) -> None:
    """A PGM or PPM states its greatest value, as text or in bytes; all values are scaled by it."""
    picture = np.arange(SIZE[0] * SIZE[1]).reshape(SIZE) % (most + 1)
    values = (picture.repeat(3, 1) if kind in {"P3", "P6"} else picture).astype(np.uint8)
    body = values.tobytes() if kind in {"P5", "P6"} else " ".join(map(str, values.flat)).encode()
    (tmp_path / "a.ppm").write_bytes(f"{kind} {SIZE[1]} {SIZE[0]} {most}\n".encode() + body)
    (frame,) = open_frames(tmp_path / "a.ppm", *SIZE)
    assert np.abs(frame - picture * 255 / most).max() <= 1
    assert frame.max() == 255


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
        refused(tmp_path / "a.png", "NP222", "a.png", f"at most {MAX_PIXELS} pixels")


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
