"""Result files are written whole or not at all; errors name the file."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from npchip.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file by way of a temporary one beside it, so that no half-written file is left.

    A device or a pipe is written directly.

    Raises:
        InputError: NP250 the file cannot be written.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        target = path.resolve()  # replace the target of a symbolic link, not the link
        temporary = target.with_name(f".{target.name[:100]}.{os.getpid()}.tmp")
        try:
            temporary.write_bytes(data)
            temporary.replace(target)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise _cannot_write(path, error.strerror or str(error)) from None


def check_writable(path: Path) -> None:
    """Raise an error before a long run if its result could not be written.

    Raises:
        InputError: NP250 `path` is a folder, or its folder is missing or not writable.
    """
    if path.is_dir():
        raise _cannot_write(path, "it is a folder")
    if not path.parent.is_dir():
        raise _cannot_write(path, f"there is no folder {path.parent}")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise _cannot_write(path, "permission denied")


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


def _cannot_write(path: Path, reason: str) -> InputError:
    return InputError("NP250", f"cannot write {path}: {reason}", hint="name another place")
