"""Writing result files: whole or not at all, with an error that names the file."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from npchip.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` to `path` by way of a temporary file beside it, so that no half file is left.

    A path that exists and is no regular file (a device, a pipe) is written directly.

    Raises:
        InputError: NP250, it cannot be written.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        target = path.resolve()  # replace what a symbolic link points to, not the link
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
    """Refuse, before a long run, a file that could not be written after it.

    Raises:
        InputError: NP250, `path` is a folder, or its folder is missing or not writable.
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
    """Refuse a file name whose suffix does not say in which format to write.

    Args:
        path: the file.
        suffixes: those that do, in lower case.
        code: of the error.
        what: subject of the message, such as ``"pictures are"``.
        example: a good name for a hint, of whose stem that of `path` takes the place.
        option: what named the file, with a blank behind it.

    Raises:
        InputError: `code`.
    """
    if path.suffix.lower() not in suffixes:
        stem, _, suffix = example.partition(".")
        raise InputError(
            code,
            f"{option}{path}: {what} written as {' or '.join(suffixes)}",
            hint=f"such as {option}{path.with_suffix('').name or stem}.{suffix}",
        )


def make_directory(path: Path) -> None:
    """Create the folder `path` with its parents where it is missing.

    Raises:
        InputError: NP250, it cannot be created or written to.
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
