"""Opening the frames of a path or pattern."""

from __future__ import annotations

import glob
from pathlib import Path

from npchip import bundle
from npchip.base.errors import InputError
from npchip.base.files import note_input
from npchip.frames import video
from npchip.frames.arrays import open_npy
from npchip.frames.fit import Fit
from npchip.frames.source import FrameSource

IMAGES = (
    *(".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"),
    *(".gif", ".webp", ".pgm", ".ppm", ".pbm", ".pnm"),
)
"""File name suffixes of images."""
_KINDS = f".npy, images ({' '.join(IMAGES)}) or video ({' '.join(video.SUFFIXES)})"


def open_frames(source: str | Path, rows: int, cols: int, fit: Fit | None = None) -> FrameSource:
    """Open the frames of a path or pattern, and check the first one.

    Args:
        source: a `.npy` file of shape (T, rows, cols) or (rows, cols); an image, with all its
            pictures if it is animated; a video; or several images, one frame each: a
            directory or a pattern such as ``"shots/*.png"``, in natural order (2 before 10).
            No other files are read. Or the name of a bundled clip.
        rows: rows of pixels of the machine.
        cols: columns of pixels of the machine.
        fit: ``"crop"`` cuts out the centre, ``"resize"`` averages areas; None refuses frames
            of another size.

    Raises:
        InputError: NP210 no such file, NP211 not readable, NP212 not a supported kind of file,
            NP213 a directory or pattern without images, NP214 damaged, NP215 no frames,
            NP216-NP218 shape and size, NP219-NP221 type and values of an array, NP222 too large,
            NP223 several pictures in an image of a list, NP224 more than 8 bits per channel,
            NP225 unknown `fit`, NP226 PyAV is missing, NP227 no video stream,
            NP228 a video at another angle. An error in a later
            frame is raised when the frame is read.
    """
    if not str(source):
        raise InputError(
            "NP210", "the name is empty: no frames are named", hint="'.' is the present directory"
        )
    path = bundle.find("clip", source)
    try:
        is_file, is_directory = path.is_file(), path.is_dir()
        present = is_file or is_directory or path.exists()
    except OSError as error:  # the name is too long, or a directory may not be entered
        raise InputError("NP211", f"{path}: cannot be read: {error.strerror}") from None
    if is_file:
        return _open_file(path, rows, cols, fit)
    if is_directory:
        return _open_list(_entries(path), f"directory {path}", rows, cols, fit)
    if present:
        raise InputError("NP211", f"{path}: neither a file nor a directory")
    if glob.has_magic(str(path)) and "\0" not in str(path):
        return _open_list(_matches(str(path)), f"pattern {path}", rows, cols, fit)
    hint = _link_hint(path) or bundle.hint("clip", source)
    raise InputError("NP210", f"{path}: no such file or directory", hint=hint)


def _open_file(path: Path, rows: int, cols: int, fit: Fit | None) -> FrameSource:
    suffix = path.suffix.lower()
    if suffix == ".npy":
        return open_npy(path, rows, cols, fit)
    if suffix in IMAGES:
        from npchip.frames.images import ImagePages  # noqa: PLC0415 - Pillow imports slowly

        return ImagePages(path, rows, cols, fit)
    if suffix in video.SUFFIXES:
        return video.VideoFrames(path, rows, cols, fit)
    hint = f"expected {_KINDS}"
    if suffix == ".npz":
        hint = "take one array out: np.save('clip.npy', np.load('clip.npz')['name'])"
    kind = f"'{path.suffix}' is not" if suffix else "a name without suffix does not tell"
    raise InputError("NP212", f"{path}: {kind} a kind of frames", hint=hint)


def _open_list(paths: list[Path], name: str, rows: int, cols: int, fit: Fit | None) -> FrameSource:
    """Open the images among `paths`, in natural order; ignore other files."""
    found = [path for path in paths if path.suffix.lower() in IMAGES and path.is_file()]
    if not found:
        others = sorted(path.name for path in paths)
        listed = f": only {', '.join(others[:3])}{', ...' if len(others) > 3 else ''}"
        raise InputError(
            "NP213",
            f"{name}: holds no images{listed if others else ''}",
            hint=f"expected files that end in {' '.join(IMAGES)}",
        )
    from npchip.frames.images import ImageList  # noqa: PLC0415 - as above
    from npchip.frames.order import in_order  # noqa: PLC0415

    ordered = in_order(found)
    for path in ordered:
        note_input(path)
    return ImageList(ordered, name, rows, cols, fit)


def _matches(pattern: str) -> list[Path]:
    """Return what matches a pattern; brackets that match nothing so stand for themselves.

    Raises:
        InputError: NP210, nothing matches, or something else where brackets stand for themselves.
    """
    literal = pattern.replace("[", "[[]")
    found, verbatim = (set(glob.glob(each)) for each in (pattern, literal))  # noqa: PTH207 - as in a shell
    if found and verbatim and found != verbatim:
        raise InputError(
            "NP210",
            f"{pattern}: matches {min(found)} as a pattern, {min(verbatim)} as it stands",
            hint=f"write '{literal}' for the latter",
        )
    if not found and not verbatim:
        raise InputError("NP210", f"{pattern}: no file matches this pattern")
    return [Path(match) for match in found or verbatim]


def _entries(directory: Path) -> list[Path]:
    """Return the files of a directory, except hidden ones such as '._x.png' of macOS."""
    try:
        return [path for path in directory.iterdir() if not path.name.startswith(".")]
    except OSError as error:
        raise InputError(
            "NP211", f"directory {directory}: cannot be read: {error.strerror}"
        ) from None


def _link_hint(path: Path) -> str | None:
    try:
        link = path.is_symlink()
    except OSError:
        return None
    return "it is a symbolic link that leads nowhere, or in a circle" if link else None
