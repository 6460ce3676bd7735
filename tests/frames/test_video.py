"""Frames from videos."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from npchip.frames import open_frames
from tests.support.frames import SIZE, load, noise, ramps, refused, video


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
