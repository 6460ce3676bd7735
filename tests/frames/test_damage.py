"""Damaged pictures and arrays: the run stops where the damage is, and not before."""

from __future__ import annotations

import io
import struct
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from npchip.base.errors import InputError
from npchip.frames import open_frames
from npchip.frames.memory import read_memory
from npchip.machine import load_machine
from tests.damage.bases import FORMS, bases
from tests.damage.trial import try_one
from tests.support.frames import SIZE, Clip, noise, refused


def read_until_damage(path: Path) -> tuple[list[Clip], InputError]:
    """The frames before the damage, and its error."""
    frames: list[Clip] = []
    with pytest.raises(InputError) as caught:
        frames.extend(open_frames(path, *SIZE))
    return frames, caught.value


def base(form: str, name: str) -> bytes:
    return dict(bases(form))[name]


@pytest.mark.long
@pytest.mark.parametrize("form", FORMS)
def test_damaged_files_are_refused_where_other_decoders_refuse_them(form: str) -> None:
    """More of them: ``python -m tests.damage``."""
    with tempfile.TemporaryDirectory() as folder:
        faults = [try_one(form, seed, Path(folder)) for seed in range(20)]
    assert not list(filter(None, faults))


def test_damage_in_the_data_of_a_jpeg(tmp_path: Path) -> None:
    """Pillow passes over all that libjpeg warns of: grey areas came out as the picture."""
    content = bytearray(base("jpeg", "progressive.jpg"))
    content[900:904] = b"\x12\x34\x56\x78"
    (tmp_path / "a.jpg").write_bytes(content)
    assert Image.open(tmp_path / "a.jpg").convert("L").size == (80, 64)
    refused(tmp_path / "a.jpg", "NP214", "FFmpeg")


def test_a_jpeg_that_ffmpeg_has_not_learnt_is_read(tmp_path: Path) -> None:
    picture = Image.fromarray(noise(*SIZE, 3)).convert("CMYK")
    picture.save(tmp_path / "a.jpg", subsampling=2)
    assert len(list(open_frames(tmp_path / "a.jpg", *SIZE))) == 1


def without_pyav(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "av", None)


def test_parts_that_a_jpeg_lacks_are_noticed_without_pyav(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lines were missing in the middle, and the rest moved up."""
    without_pyav(monkeypatch)
    whole = base("jpeg", "restart.jpg")
    (tmp_path / "a.jpg").write_bytes(whole)
    assert len(list(open_frames(tmp_path / "a.jpg", *SIZE))) == 1
    second, third = whole.index(b"\xff\xd1"), whole.index(b"\xff\xd2")
    (tmp_path / "a.jpg").write_bytes(whole[:second] + whole[third:])
    refused(tmp_path / "a.jpg", "NP214", "not in order")
    (tmp_path / "a.jpg").write_bytes(whole[:-2])
    refused(tmp_path / "a.jpg", "NP214", "cut short")


def test_a_film_behind_a_photo_and_notes_before_it_are_no_damage(tmp_path: Path) -> None:
    whole = base("jpeg", "colour.jpg")
    note = b"\xff\xe1\x00\x12Exif\0\0broken note"[:20]
    (tmp_path / "a.jpg").write_bytes(whole[:2] + note + b"\xff" + whole[2:] + b"\0\0ftypmp42" * 9)
    wanted = np.asarray(Image.open(io.BytesIO(whole)).convert("L"))
    assert (next(iter(open_frames(tmp_path / "a.jpg", *SIZE))) == wanted).all()


@pytest.mark.parametrize("name", ["jpeg.tif", "grey_jpeg.tif"])
def test_a_cut_jpeg_within_a_tiff(tmp_path: Path, name: str) -> None:
    """The lower part of the picture came out grey."""
    content = bytearray(base("tiff", name))
    end = content.rindex(b"\xff\xd9")
    content[end - 300 : end + 2] = bytes(302)
    (tmp_path / "a.tif").write_bytes(content)
    refused(tmp_path / "a.tif", "NP214")


@pytest.mark.parametrize("form", [form for form in FORMS if form not in ("yaml", "npo", "npy")])
def test_whole_files_of_all_kinds_are_read(tmp_path: Path, form: str) -> None:
    for name, content in bases(form):
        if name == "deep.png":
            continue
        (tmp_path / name).write_bytes(content)
        assert list(open_frames(tmp_path / name, *SIZE)), name


@pytest.mark.parametrize(
    ("name", "tag", "value"),
    [("grey.tif", 257, 66), ("tiles.tif", 256, 208), ("endian.tif", 257, 4160)],
)
def test_a_tiff_that_is_larger_than_what_it_holds(
    tmp_path: Path, name: str, tag: int, value: int
) -> None:
    """The rest was black."""
    content = base("tiff", name)
    order = "<" if content.startswith(b"II") else ">"
    wide = content.replace(
        struct.pack(f"{order}HHII", tag, 4, 1, 80 if tag == 256 else 64),
        struct.pack(f"{order}HHII", tag, 4, 1, value),
    )
    narrow = content.replace(
        struct.pack(f"{order}HHIHH", tag, 3, 1, 64, 0),
        struct.pack(f"{order}HHIHH", tag, 3, 1, value, 0),
    )
    (tmp_path / "a.tif").write_bytes(narrow if wide == content else wide)
    refused(tmp_path / "a.tif", "NP214", fit="resize")


def test_more_packed_bytes_than_pixels_in_a_tiff(tmp_path: Path) -> None:
    """Bytes that stood twice moved the rest of the picture."""
    content = bytearray(base("tiff", "packbits.tif"))
    size = content[8] + 2  # of the first literal bytes with their number
    content[8 : 8 + size] = (b"\x81\x07" * 3).ljust(size, b"\x80")  # three runs, then nothing
    (tmp_path / "a.tif").write_bytes(content)
    refused(tmp_path / "a.tif", "NP214")


@pytest.mark.parametrize("rest", [b"P2\n80 64\n255\n", b"x", b" " * (2 << 20)])
def test_what_follows_a_picture_in_text(tmp_path: Path, rest: bytes) -> None:
    """It was left out without a word, as a second picture would be."""
    (tmp_path / "a.pgm").write_bytes(base("pgm", "text.pgm") + b"# P5 is a word here\n" + rest)
    refused(tmp_path / "a.pgm", "NP214")


def test_pixels_within_the_header_of_a_bmp(tmp_path: Path) -> None:
    content = bytearray(base("bmp", "bits.bmp"))
    content[10] = 46
    (tmp_path / "a.bmp").write_bytes(content)
    refused(tmp_path / "a.bmp", "NP214", "header")


def test_damage_in_a_fax_page(tmp_path: Path) -> None:
    content = bytearray(base("tiff", "fax.tif"))
    content[200:230] = bytes(30)
    (tmp_path / "a.tif").write_bytes(content)
    refused(tmp_path / "a.tif", "NP214", "frame 0")


def test_a_tag_of_a_tiff_that_cannot_be_read(tmp_path: Path) -> None:
    """Its bits a pixel were taken as one: eight pixels became one."""
    content = bytearray(base("tiff", "grey.tif"))
    entry = content.index(struct.pack("<HHI", 258, 3, 1))
    content[entry + 2 : entry + 12] = struct.pack("<HII", 3, 1 << 20, 8)
    (tmp_path / "a.tif").write_bytes(content)
    refused(tmp_path / "a.tif", "NP214", "tag 258")


@pytest.mark.parametrize("keep", [12, 400])
def test_a_png_without_an_end(tmp_path: Path, keep: int) -> None:
    """Bytes behind its pixels were taken as pixels."""
    (tmp_path / "a.png").write_bytes(base("png", "stored.png")[:-keep])
    refused(tmp_path / "a.png", "NP214")


def test_the_pictures_before_a_damaged_one_are_frames(tmp_path: Path) -> None:
    """The whole file was refused, as no video is."""
    frames = list(map(np.asarray, noise(4, *SIZE)))
    first, *others = map(Image.fromarray, frames)
    for suffix in ("png", "gif", "tif"):
        path = tmp_path / f"a.{suffix}"
        first.save(path, save_all=True, append_images=others, duration=50)
        whole = list(open_frames(path, *SIZE))
        content = bytearray(path.read_bytes())
        if suffix == "png":
            content[content.index(b"fdAT", content.index(b"fdAT") + 4) + 99] ^= 8
        elif suffix == "gif":
            del content[-len(content) // 4 - 9 :]
        else:
            at = content.rindex(struct.pack("<HHI", 273, 4, 1)) + 8
            content[at : at + 4] = b"\xff\xff\xff\x7f"
        path.write_bytes(content)
        before, error = read_until_damage(path)
        assert error.code == "NP214", error
        assert 2 <= len(before) <= 3
        assert f"frame {len(before)}" in error.message
        assert all(map(np.array_equal, before, whole))


def test_a_second_picture_of_a_pgm_that_is_none(tmp_path: Path) -> None:
    content = base("pgm", "grey.pgm")
    (tmp_path / "a.pgm").write_bytes(content + b"rubbish")
    before, error = read_until_damage(tmp_path / "a.pgm")
    assert len(before) == 1
    assert error.code == "NP214"
    (tmp_path / "list").mkdir()
    (tmp_path / "a.pgm").rename(tmp_path / "list" / "a.pgm")
    refused(tmp_path / "list", "NP214")


@pytest.mark.parametrize(
    ("form", "name"),
    [("bmp", "bits.bmp"), ("bmp", "runs.bmp"), ("bmp", "colour.bmp"), ("webp", "lossy.webp")],
)
def test_another_length_than_a_bmp_or_webp_states(tmp_path: Path, form: str, name: str) -> None:
    """Two bytes less in a row's padding were not missed, others behind the end not seen."""
    whole = base(form, name)
    path = tmp_path / name
    for content in (whole[:-2], whole + b"more"):
        path.write_bytes(content)
        refused(path, "NP214")
    path.write_bytes(whole + bytes(3))  # some programs fill up
    assert len(list(open_frames(path, *SIZE))) == 1


def test_a_header_of_an_array_that_is_no_expression(tmp_path: Path) -> None:
    """NumPy's reader fails with an error of Python's tokenizer, which was not expected."""
    path = tmp_path / "a.npy"
    np.save(path, np.zeros((1, 8, 8), np.uint8))
    content = path.read_bytes()
    path.write_bytes(content.replace(b"'descr'", b"'desc\0("))
    with pytest.raises(InputError) as caught:
        read_memory(0, path, load_machine("default"))
    assert caught.value.code == "NP243"
    refused(path, "NP214")


def test_a_header_that_claims_to_be_long_takes_no_memory(tmp_path: Path) -> None:
    """Four gigabytes were read before the claim was refused."""
    import resource

    path = tmp_path / "a.npy"
    with path.open("wb") as file:
        file.write(b"\x93NUMPY\x02\x00\xff\xff\xff\xff{'descr'")
        file.truncate(1 << 30)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    refused(path, "NP214")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100 << 10


def test_a_wide_clip_is_checked_in_little_memory(tmp_path: Path) -> None:
    """All of it was in memory at once to find its largest number."""
    path = tmp_path / "a.npy"
    clip = np.zeros((5, *SIZE), np.int64)
    clip[-1, 3, 4] = 300
    np.save(path, clip)
    refused(path, "NP220", "found 0 to 300", "9 bits")
    clip[-1, 3, 4] = 255
    np.save(path, np.asfortranarray(clip))
    assert (np.array(list(open_frames(path, *SIZE))) == clip).all()
