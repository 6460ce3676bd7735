"""The JSON of a run, and what --save writes."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.base.files import check_writable, make_directory, write_bytes
from npchip.report.jsonform import save, to_document, to_text
from npchip.run.result import FrameRecord, RunError
from tests.support.results import imaged, made


def strict(text: str) -> Any:
    def refuse(constant: str) -> None:
        pytest.fail(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def test_document_follows_the_contract() -> None:
    result = made({"center_row": np.array([31, 7], np.int32)}, [10, 12])
    assert strict(to_text(to_document(result, 10_000_000))) == {
        "schema": 1,
        "program": "made",
        "engine": "reference",
        "machine": "default",
        "status": "frames-exhausted",
        "instructions": 27,
        "cycles": 27,
        "clock_hz": 10_000_000,
        "setup": {"cycles": 5, "outputs": {"center_row": None}},
        "frames": [
            {"index": 0, "cycles": 10, "outputs": {"center_row": 31}},
            {"index": 1, "cycles": 12, "outputs": {"center_row": 7}},
        ],
    }


def test_keys_keep_the_order_of_the_contract() -> None:
    error = RunError("NP301", "disagree", address=17, file="a.s", line=40)
    document = strict(to_text(to_document(made({}, [1], status="failed", error=error), 1)))
    assert list(document) == [
        "schema",
        "program",
        "engine",
        "machine",
        "status",
        "error",
        "instructions",
        "cycles",
        "clock_hz",
        "setup",
        "frames",
    ]
    assert document["error"] == {
        "code": "NP301",
        "message": "disagree",
        "address": 17,
        "file": "a.s",
        "line": 40,
    }


def test_error_without_a_place_has_nulls() -> None:
    result = made({}, [1], status="failed", error=RunError("NP320", "slow"))
    assert to_document(result, 1)["error"] == {
        "code": "NP320",
        "message": "slow",
        "address": None,
        "file": None,
        "line": None,
    }


def test_every_kind_of_output() -> None:
    plane = np.arange(6, dtype=np.uint8).reshape(1, 2, 3)
    outputs = {
        "scalar": np.ma.masked_array(np.array([9, 1], np.int32), [False, True]),
        "list": [[np.uint8(3), 4], None],
        "plane": np.ma.masked_array(
            np.concatenate([plane, plane]), np.array([False, True])[:, None, None] | (plane < 0)
        ),
    }
    frames = strict(to_text(to_document(made(outputs, [1, 1]), 1)))["frames"]
    assert frames[0]["outputs"] == {
        "scalar": 9,
        "list": [3, 4],
        "plane": [[0, 1, 2], [3, 4, 5]],
    }
    assert frames[1]["outputs"] == {"scalar": None, "list": None, "plane": None}


def test_only_a_frame_cut_short_says_so() -> None:
    frames = to_document(made({}, [1, 2], last_complete=False), 1)["frames"]
    assert "complete" not in frames[0]
    assert frames[1]["complete"] is False


def test_set_up_cut_short_and_no_frames() -> None:
    setup = FrameRecord(cycles=7, instructions=7, outputs={"x": 3}, complete=False)
    document = strict(to_text(to_document(made({}, [], setup=setup), 1)))
    assert document["setup"] == {"cycles": 7, "outputs": {"x": 3}, "complete": False}
    assert document["frames"] == []


def test_index_counts_from_the_reset_of_the_chip() -> None:
    frames = to_document(made({}, [1, 1], first_frame=10), 1)["frames"]
    assert [frame["index"] for frame in frames] == [10, 11]


def test_text_has_one_line_for_each_frame() -> None:
    result = imaged(np.zeros((3, 4, 4), np.uint8))
    lines = to_text(to_document(result, 1)).splitlines()
    assert sum('"index"' in line for line in lines) == 3


def test_save_writes_arrays_and_names_them(tmp_path: Path) -> None:
    clip = np.arange(3 * 16 * 16, dtype=np.uint16).reshape(3, 16, 16).astype(np.uint8)
    folder = tmp_path / "new" / "folder"
    result = imaged(clip)
    save(result, 5, folder)
    save(result, 5, folder)
    assert sorted(path.name for path in folder.iterdir()) == ["picture.npy", "run.json"]
    document = strict((folder / "run.json").read_text())
    for k, frame in enumerate(document["frames"]):
        place = frame["outputs"]["picture"]
        assert place == {"file": "picture.npy", "index": k}
        assert np.array_equal(np.load(folder / place["file"])[place["index"]], clip[k])


def test_saved_array_is_zero_where_nothing_was_sent(tmp_path: Path) -> None:
    planes = np.ma.masked_array(np.full((2, 8, 10), 7, np.uint8))
    planes[1] = np.ma.masked
    save(made({"port3": planes}, [1, 1]), 5, tmp_path)
    saved = np.load(tmp_path / "port3.npy")
    assert (saved[0] == 7).all()
    assert (saved[1] == 0).all()
    frames = strict((tmp_path / "run.json").read_text())["frames"]
    assert frames[1]["outputs"]["port3"] is None


def test_save_stays_inside_its_folder(tmp_path: Path) -> None:
    result = made({"../evil": np.zeros((1, 8, 10), np.uint8)}, [1])
    with pytest.raises(InputError, match="NP253"):
        save(result, 5, tmp_path / "inner")
    assert not list(tmp_path.glob("*.npy"))


def test_write_replaces_whole_files_and_follows_links(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_bytes(link, b"new")
    assert target.read_bytes() == b"new"
    assert link.is_symlink()
    assert len(list(tmp_path.iterdir())) == 2


def test_write_goes_straight_to_devices() -> None:
    write_bytes(Path(os.devnull), b"x")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_full_disk_is_an_error_that_names_the_file() -> None:
    with pytest.raises(InputError, match=r"cannot write /dev/full: No space left.*NP250"):
        write_bytes(Path("/dev/full"), b"x")


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"")
    for path in (tmp_path, tmp_path / "missing" / "x", file / "x"):
        with pytest.raises(InputError, match="NP250"):
            check_writable(path)
    for path in (tmp_path / "missing" / "x", file / "x"):
        with pytest.raises(InputError, match="NP250"):
            write_bytes(path, b"")
    for path in (file, file / "x"):
        with pytest.raises(InputError, match="NP250"):
            make_directory(path)
