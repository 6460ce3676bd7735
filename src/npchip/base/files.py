"""Files read within limits and written whole or not at all; errors name the file.

While `guarded` is open, no file is read and written both, whatever its names.
"""

from __future__ import annotations

import errno
import os
import stat
import sys
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from npchip.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

_Key = tuple[int, int] | str  # device and inode; the path of a file that does not exist


class _Guard:
    """The files that a command reads and writes, by what they are and not by name."""

    def __init__(self) -> None:
        self.read: dict[_Key, Path] = {}
        self.written: dict[_Key, Path] = {}
        self.done: set[_Key] = set()


_guards: list[_Guard] = []


@contextmanager
def guarded() -> Iterator[None]:
    """Refuse within the context to write what is read, and to write one file twice."""
    _guards.append(_Guard())
    try:
        yield
    finally:
        _guards.pop()


def _key(path: Path) -> _Key:
    try:
        found = path.stat()
    except (OSError, ValueError):
        return os.path.realpath(path)
    return found.st_dev, found.st_ino


def note_input(path: Path, key: _Key | None = None) -> None:
    """Note that a file is read, or will be.

    Raises:
        InputError: NP254, it is an output of the command too.
    """
    for guard in _guards[-1:]:
        key = key or _key(path)
        guard.read.setdefault(key, path)  # also then: the error may be caught
        if key in guard.written:
            raise _both(guard.written[key], path, "reads")


def _note_output(path: Path, *, now: bool) -> None:
    """Note that a file will be written, or is written `now`."""
    for guard in _guards[-1:]:
        key = _key(path)
        if key in guard.read:
            raise _both(path, guard.read[key], "reads")
        if key in (guard.done if now else guard.written):
            raise _both(path, guard.written[key], "writes")
        guard.written[key] = path


def _replaced(path: Path, old: _Key, *, over: bool) -> None:
    """Note what a file has become; its old inode may now be that of another."""
    for guard in _guards[-1:]:
        guard.read.pop(old, None)
        guard.written.pop(old, None)
        (guard.read if over else guard.written)[_key(path)] = path
        guard.done.add(_key(path))


def _both(output: Path, other: Path, verb: str) -> InputError:
    same = "" if str(other) == str(output) else f", by the name {other},"
    return InputError(
        "NP254",
        f"cannot write {output}: the command{same} {verb} this file{' twice' * (verb == 'writes')}",
        hint="name another file to write",
    )


# ---- reading


def open_input(path: Path) -> BinaryIO:
    """Open a regular file to read. A pipe or a device is refused, as it may block or never end.

    Raises:
        OSError: it cannot be opened, or is no regular file.
        InputError: NP254 as `note_input`.
    """
    try:
        file = open(path, "rb", opener=_open_at_once)  # noqa: SIM115 - the caller closes it
    except ValueError as error:  # a zero byte, or a character that file names cannot have here
        raise OSError(errno.EINVAL, f"no name of a file: {error}") from None
    try:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            message = "not a regular file, but a pipe or a device"
            raise OSError(errno.EINVAL, message)  # noqa: TRY301
        note_input(path, (found.st_dev, found.st_ino))
    except BaseException:
        file.close()
        raise
    return file


def _open_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def read_bytes(path: Path, most: int) -> bytes:
    """Return the content of a regular file.

    Raises:
        OSError: it cannot be read, or is larger than `most` bytes.
        InputError: NP254 as `note_input`.
    """
    with open_input(path) as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"larger than {most:,} bytes")
    return data


# ---- writing


def write_text(path: Path, text: str, *, over: bool = False) -> None:
    """Write a text in UTF-8; arguments and errors as for `write_bytes`.

    A file name in it that is no text in this locale is written byte for byte where that gives
    UTF-8, and else with escapes as in JSON, which reads them back.
    """
    try:
        data = text.encode("utf-8", "surrogateescape")
        data.decode()
    except ValueError:
        data = text.encode("utf-8", "backslashreplace")
    write_bytes(path, data, over=over)


def write_bytes(path: Path, data: bytes, *, over: bool = False) -> None:
    """Write a file by way of a temporary one beside it, so that no half-written file is left.

    A device or a pipe is written directly. An older file's permissions are kept.

    Args:
        path: the file.
        data: its content.
        over: whether the command may have read it, to change it.

    Raises:
        InputError: NP250 the file cannot be written; NP254 the command reads it.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        if not over:
            _note_output(path, now=True)
        old, target = _key(path), Path(os.path.realpath(path))  # a link stays
        # Short, as the name of the file itself may be as long as the system allows.
        temporary = target.with_name(f".npchip-{os.getpid()}.tmp")
        with uninterrupted():
            try:
                temporary.write_bytes(data)
                if target.exists():
                    with suppress(OSError):
                        temporary.chmod(stat.S_IMODE(target.stat().st_mode))
                temporary.replace(target)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
        _replaced(path, old, over=over)
    except OSError as error:
        raise _cannot_write(path, error.strerror or str(error)) from None


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other processes out of this context for the same folder, where the system can."""
    if sys.platform == "win32":
        yield
        return
    import fcntl  # noqa: PLC0415 - not on Windows

    handle = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # a network's file system may have no locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def check_writable(*paths: Path) -> None:
    """Raise an error before a long run if its results could not be written.

    Raises:
        InputError: NP250 a path is a folder, or its folder is missing or not writable; NP254 the
            command reads the file, or writes another output to it.
    """
    for path in paths:
        if path.is_dir():
            raise _cannot_write(path, "it is a folder")
        if not path.parent.is_dir():
            raise _cannot_write(path, f"there is no folder {path.parent}")
        places = [path] if path.exists() else []
        if not path.exists() or path.is_file():
            places.append(Path(os.path.realpath(path)).parent)  # for the temporary file
        if not all(os.access(place, os.W_OK) for place in places):
            raise _cannot_write(path, "permission denied")
        if not path.exists() or path.is_file():
            _note_output(path, now=False)


def check_suffix(
    path: Path, suffixes: Sequence[str], code: str, *, what: str, example: str, option: str = ""
) -> None:
    """Raise an error if a file's suffix names no known format.

    Args:
        path: the file.
        suffixes: the known suffixes, in lower case.
        code: the error's code.
        what: subject of the message, such as ``"pictures are"``.
        example: a file name for the hint, which shows it with the stem of `path`.
        option: the option that named the file, with a blank after it.

    Raises:
        InputError: `code` the suffix is unknown.
    """
    if path.suffix.lower() not in suffixes:
        stem, _, suffix = example.partition(".")
        raise InputError(
            code,
            f"{option}{path}: {what} written as {' or '.join(suffixes)}",
            hint=f"such as {option}{path.with_suffix('').name or stem}.{suffix}",
        )


def make_directory(path: Path) -> None:
    """Create a folder with its parents unless it exists.

    Raises:
        InputError: NP250 it cannot be created or written to.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise _cannot_write(path, "it is a file, not a folder") from None
    except OSError as error:
        raise _cannot_write(path, error.strerror or str(error)) from None
    if not os.access(path, os.W_OK):
        raise _cannot_write(path, "permission denied")


def write_new(files: Mapping[Path, bytes], hint: str) -> None:
    """Write files with the folders that they need; overwrite nothing.

    Args:
        files: the content of each file.
        hint: the remedy if one of them is there already.

    Raises:
        InputError: NP256, one of them is there already, and nothing is written; NP250, a file
            cannot be written.
    """
    present = [path for path in files if path.exists() or path.is_symlink()]
    if present:
        others = f" and {len(present) - 1} more files" if len(present) > 1 else ""
        message = f"{present[0]}{others}: there already, nothing is written"
        raise InputError("NP256", message, hint=hint)
    with uninterrupted():
        for path, data in files.items():
            make_directory(path.parent)
            write_bytes(path, data)


def _cannot_write(path: Path, reason: str) -> InputError:
    return InputError("NP250", f"cannot write {path}: {reason}", hint="name another place")


# ---- signals

_held = 0
_late: list[BaseException] = []


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Let `raise_soon` wait for the end of the context."""
    global _held  # noqa: PLW0603 - of the process, as signal handlers are
    _held += 1
    try:
        yield
    finally:
        _held -= 1
        if not _held and _late:
            raise _late.pop()


def raise_soon(error: BaseException) -> None:
    """Raise an exception for a signal now, or at the end of what must not be interrupted."""
    if not _held:
        raise error
    _late[:] = [error]
