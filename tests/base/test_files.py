"""Files are read within limits, and written whole, once, and never over what is read."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from npchip.base import files
from npchip.base.errors import InputError


def test_what_is_read_is_not_written_by_another_name(tmp_path: Path) -> None:
    source, link, hard = (tmp_path / name for name in ("a.s", "link", "hard"))
    source.write_text("x")
    link.symlink_to(source)
    hard.hardlink_to(source)
    for output in (source, link, hard, tmp_path / "." / "a.s"):
        with files.guarded():
            assert files.read_bytes(source, 10) == b"x"
            with pytest.raises(InputError, match="NP254"):
                files.check_writable(output)
            with pytest.raises(InputError, match="NP254"):
                files.write_text(output, "y")
        with files.guarded():  # the output is named before the file is read
            files.check_writable(output)
            with pytest.raises(InputError, match="NP254"):
                files.open_input(source)
    assert source.read_text() == "x"
    files.write_text(link, "y")  # outside of a command it is the caller's decision
    assert source.read_text() == "y"


def test_two_outputs_are_two_files(tmp_path: Path) -> None:
    one = tmp_path / "one"
    with files.guarded(), pytest.raises(InputError, match=r"twice.*NP254"):
        files.check_writable(one, tmp_path / "." / "one")
    with files.guarded():
        files.check_writable(one)
        files.write_text(one, "1")
        with pytest.raises(InputError, match=r"twice.*NP254"):
            files.write_text(one, "2")
        files.write_text(tmp_path / "two", "2")
    assert one.read_text() == "1"


def test_what_a_command_changes_on_purpose_is_read_and_written(tmp_path: Path) -> None:
    golden = tmp_path / "golden"
    golden.write_text("old")
    with files.guarded():
        for text in ("new", "newer"):
            files.read_bytes(golden, 10)
            files.write_text(golden, text, over=True)
        with pytest.raises(InputError, match="NP254"):
            files.check_writable(golden)
    assert golden.read_text() == "newer"


def test_pipes_and_devices_are_refused_at_once_and_sizes_bounded(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero"), Path("/dev/null")):
        with pytest.raises(OSError, match="not a regular file"):
            files.open_input(path)
    large = tmp_path / "large"
    with large.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(OSError, match="larger than 5 bytes"):
        files.read_bytes(large, 5)
    with pytest.raises(OSError, match="name of a file"):
        files.open_input(Path("a\0b"))


@pytest.mark.parametrize("name", ["x" * 255, "ü" * 127, "漢" * 85])
def test_a_name_may_be_as_long_as_the_system_allows(tmp_path: Path, name: str) -> None:
    files.check_writable(tmp_path / name)
    files.write_text(tmp_path / name, "x")
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_permissions_of_an_older_file_are_kept(tmp_path: Path) -> None:
    private = tmp_path / "private"
    private.write_text("old")
    private.chmod(0o600)
    files.write_text(private, "new")
    assert stat.S_IMODE(private.stat().st_mode) == 0o600


def test_names_that_are_no_text_are_written(tmp_path: Path) -> None:
    files.write_text(tmp_path / "a", "in \udcff.s")
    assert (tmp_path / "a").read_text() == "in \\udcff.s"
    files.write_text(tmp_path / "b", "in \udcc3\udcbc.s")  # an umlaut in a locale without
    assert (tmp_path / "b").read_text("utf-8") == "in ü.s"


def test_a_signal_waits_until_the_file_is_whole(tmp_path: Path) -> None:
    def write() -> None:
        with files.uninterrupted():
            files.raise_soon(KeyboardInterrupt())
            files.write_text(tmp_path / "a", "whole")

    with pytest.raises(KeyboardInterrupt):
        write()
    assert (tmp_path / "a").read_text() == "whole"
    with pytest.raises(KeyboardInterrupt):
        files.raise_soon(KeyboardInterrupt())
