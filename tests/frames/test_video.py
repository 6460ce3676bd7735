"""Frames from videos."""

from __future__ import annotations

import pickle
import shutil
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.frames import open_frames
from tests import damage_video
from tests.support.frames import SIZE, Clip, load, noise, ramps, refused, video


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


UPRIGHT: dict[str, Callable[[Clip], Clip]] = {
    "1 0 0 1": lambda picture: picture,
    "0 1 -1 0": lambda picture: np.rot90(picture, -1),
    "-1 0 0 -1": lambda picture: np.rot90(picture, 2),
    "0 -1 1 0": np.rot90,
    "-1 0 0 1": np.fliplr,
    "1 0 0 -1": np.flipud,
    "0 1 1 0": np.transpose,
    "0 -1 -1 0": lambda picture: np.rot90(picture, 2).T,
}


def oriented(path: Path, clip: Clip, matrix: str) -> Path:
    """Write a video with a display matrix: x' = ax + cy, y' = bx + dy."""
    content = video(path, clip).read_bytes()
    straight, other = (
        b"".join(
            struct.pack(">iii", *(int(float(number) * 65536) for number in row.split()), 0)
            for row in (" ".join(text.split()[:2]), " ".join(text.split()[2:]))
        )
        for text in ("1 0 0 1", matrix)
    )
    place = content.index(straight, content.index(b"tkhd"))
    path.write_bytes(content[:place] + other + content[place + len(straight) :])
    return path


@pytest.mark.parametrize("matrix", UPRIGHT)
def test_video_is_turned_and_mirrored(tmp_path: Path, matrix: str) -> None:
    """A mirror in the display matrix was left out, or taken as half a turn."""
    wanted = ramps(1, *SIZE)[0]
    wanted[:32, :40] = 250
    stored = next(p for p in turns(wanted) if np.array_equal(UPRIGHT[matrix](p), wanted))
    frame = load(oriented(tmp_path / "a.mp4", stored[None], matrix))[0]
    assert abs(frame.astype(int) - wanted).mean() < 5


def turns(picture: Clip) -> list[Clip]:
    """All ways to turn and mirror a picture."""
    return [np.rot90(each, count) for each in (picture, picture.T) for count in range(4)]


def test_a_video_that_stands_askew_is_refused(tmp_path: Path) -> None:
    """It was read as if it stood upright."""
    refused(oriented(tmp_path / "a.mp4", ramps(1, *SIZE), "0.7 0.7 -0.7 0.7"), "NP228", "frame 0")


@pytest.mark.parametrize(
    ("name", "codec", "layout"),
    [("a.mov", "png", "rgba"), ("a.mov", "qtrle", "argb"), ("a.webm", "libvpx-vp9", "yuva420p")],
)
def test_transparent_parts_of_a_video_are_black(
    tmp_path: Path, name: str, codec: str, layout: str
) -> None:
    """They were shown in the colour that lies below."""
    pixels = np.full((*SIZE, 4), 200, np.uint8)
    pixels[..., 3] = 255
    pixels[:32, :, 3] = 0
    frame = load(written(tmp_path / name, codec, layout, [pixels]))[0].astype(int)
    assert frame[:30].max() < 4
    assert abs(frame[34:] - 200).max() < 4


def test_half_transparent_parts_of_a_video_are_darker_in_proportion(tmp_path: Path) -> None:
    """Each pixel is luma × alpha ÷ 255, rounded to the nearest."""
    pixels = np.empty((*SIZE, 4), np.uint8)
    pixels[..., :3] = 3 * np.arange(SIZE[1])[:, None] + 2
    pixels[..., 3] = 255
    opaque = load(written(tmp_path / "a.mov", "png", "rgba", [pixels]))[0].astype(float)
    pixels[..., 3] = alpha = 4 * np.arange(SIZE[0])[:, None] + 1
    frame = load(written(tmp_path / "b.mov", "png", "rgba", [pixels]))[0]
    assert np.array_equal(frame, np.floor(opaque * alpha / 255 + 0.5))


def written(
    path: Path, codec: str, layout: str, pictures: list[Any], given: str = "rgba", **options: str
) -> Path:
    """Write pictures of any layout as a video."""
    import av

    with av.open(str(path), "w") as container:
        stream: Any = container.add_stream(codec, rate=25, options=options)
        stream.height, stream.width = pictures[0].shape[:2]
        stream.pix_fmt = layout
        for picture in pictures:
            frame = av.VideoFrame.from_ndarray(picture, given)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return path


def test_depths_of_video(tmp_path: Path) -> None:
    """Values of 12 bits in a format of 16 were read as black."""
    picture = np.full(SIZE, 2048, np.uint16)
    deep = written(tmp_path / "a.mkv", "ffv1", "gray16le", [picture], "gray16le")
    refused(deep, "NP224", "gray16le", "8 bits")
    frame = load(written(tmp_path / "b.mkv", "ffv1", "gray12le", [picture], "gray12le"))[0]
    assert abs(frame.astype(int) - 128).max() <= 1


def test_a_cover_picture_is_no_video(tmp_path: Path) -> None:
    """The cover of a sound file was read as a clip of one frame."""
    import av

    with av.open(str(tmp_path / "a.mp4"), "w") as container:
        sound = container.add_stream("aac", rate=8000, layout="mono")
        cover: Any = container.add_stream("mjpeg", rate=1)
        cover.height, cover.width, cover.pix_fmt = *SIZE, "yuvj420p"
        cover.disposition = 0x0400
        picture = av.VideoFrame.from_ndarray(np.repeat(noise(*SIZE)[..., None], 3, 2), "rgb24")
        container.mux([*cover.encode(picture), *cover.encode()])
        block = av.AudioFrame.from_ndarray(np.zeros((1, 1024), np.float32), "fltp", "mono")
        block.sample_rate = 8000
        container.mux([*sound.encode(block), *sound.encode()])
    refused(tmp_path / "a.mp4", "NP227")


def test_damage_that_the_decoder_knows_of_ends_the_clip_there(tmp_path: Path) -> None:
    """A wrong checksum was passed over: the frame was made up from the one before."""
    path = written(
        tmp_path / "a.mkv", "ffv1", "gray", list(noise(9, *SIZE)), "gray", level="3", slicecrc="1"
    )
    content = bytearray(path.read_bytes())
    content[len(content) * 2 // 3] ^= 0x55
    path.write_bytes(content)
    source = open_frames(path, *SIZE)
    for _ in range(2):
        seen: list[Clip] = []
        with pytest.raises(InputError, match=r"frame 5: damaged.*CRC") as caught:
            seen.extend(source)
        assert caught.value.code == "NP214"
        assert len(seen) == 5


def test_a_change_in_the_header_of_a_video_that_ffmpeg_reports_is_damage(tmp_path: Path) -> None:
    """Demuxers report in their log only, and went on with what they could make of the rest."""
    path = written(tmp_path / "a.mpg", "mpeg2video", "yuv420p", rgba(noise(9, *SIZE)))
    content = path.read_bytes()
    place = content.index(b"\0\0\1\xb3") + 4
    path.write_bytes(content[:place] + b"\0\0\0" + content[place + 3 :])
    refused(path, "NP214")
    path = written(tmp_path / "a.webm", "libvpx-vp9", "yuv420p", rgba(noise(9, *SIZE)))
    content = path.read_bytes()
    place = content.index(b"\x15\x49\xa9\x66") + 8
    path.write_bytes(content[:place] + b"\xff" + content[place + 1 :])
    refused(path, "NP214")


def test_times_that_contradict_the_order_of_frames_are_damage(tmp_path: Path) -> None:
    """Frames came in another order than that of their times."""
    path = written(tmp_path / "a.mp4", "mpeg4", "yuv420p", rgba(ramps(9, *SIZE)), bf="2")
    content = path.read_bytes()
    place = content.index(b"ctts") + 12  # how many frames the first delay is for
    path.write_bytes(content[:place] + b"\0\0\0\x09" + content[place + 4 :])
    refused(path, "NP214", "time")


def rgba(clip: Clip) -> list[Clip]:
    """Opaque pictures of grey."""
    return [np.dstack([picture] * 3 + [np.full_like(picture, 255)]) for picture in clip]


def test_what_follows_the_end_of_a_matroska_file_is_no_part_of_it(tmp_path: Path) -> None:
    """Frames of another file behind it were read as its own."""
    path = written(tmp_path / "a.mkv", "mjpeg", "yuvj420p", rgba(noise(5, *SIZE)))
    content = path.read_bytes()
    path.write_bytes(content + content[content.index(b"\x1f\x43\xb6\x75") :])
    assert len(load(path)) == 5


@pytest.mark.parametrize("codec", ["mpeg1video", "mpeg2video"])
def test_a_cut_mpg_is_refused(tmp_path: Path, codec: str) -> None:
    """Its last frame was half a picture, and the clip ended there without a word."""
    path = written(tmp_path / "a.mpg", codec, "yuv420p", rgba(ramps(9, *SIZE) + noise(*SIZE) // 8))
    whole, content = load(path), path.read_bytes()
    for cut in range(25, len(content), 431):
        path.write_bytes(content[:cut])
        seen: list[Clip] = []
        with pytest.raises(InputError, match="damaged"):
            seen.extend(open_frames(path, *SIZE))
        assert np.array_equal(seen, whole[: len(seen)]) or not seen


def test_a_video_travels_between_processes(tmp_path: Path) -> None:
    """A source held a module, which cannot be pickled."""
    source = open_frames(video(tmp_path / "a.mp4", ramps(3, *SIZE)), *SIZE)
    other = pickle.loads(pickle.dumps(source))  # noqa: S301 - its own
    assert np.array_equal(list(other), list(source))


@pytest.mark.long
@pytest.mark.parametrize("suffix", damage_video.STREAMS)
def test_damage_that_ffmpeg_reports_is_never_read(suffix: str) -> None:
    """Frames that differ from the whole file's came without an error."""
    verdicts = damage_video.campaign(suffix, 48, 0, shutil.which("ffmpeg"))
    assert not [verdict for verdict in verdicts if verdict.isupper()], verdicts


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


@pytest.mark.parametrize("name", ["a.avi", "a.mp4", "a.mkv", "a.webm"])
def test_a_video_that_ends_between_two_frames_is_cut_short(tmp_path: Path, name: str) -> None:
    """A part of a video was read as if it was the whole."""
    import av

    codec = "libvpx" if name.endswith("webm") else "mjpeg"
    options = {"movflags": "faststart"} if name.endswith("mp4") else {}
    path = tmp_path / name
    layout = "yuv420p" if codec == "libvpx" else "yuvj420p"
    colours = [np.repeat(picture[..., None], 3, 2) for picture in noise(9, *SIZE)]
    with av.open(str(path), "w", options=options) as container:
        stream: Any = container.add_stream(codec, rate=25)
        (stream.height, stream.width), stream.pix_fmt = SIZE, layout
        for picture in colours:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, "rgb24")))
        container.mux(stream.encode())
    with av.open(str(path)) as container:
        ends = [packet.pos for packet in container.demux(video=0) if packet.pos]
    whole = path.read_bytes()
    assert len(load(path)) == 9
    path.write_bytes(whole + b"bytes behind the end")
    assert len(load(path)) == 9
    path.write_bytes(whole[: ends[6] - 8])
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
