"""Other decoders, and what they say of a file."""

from __future__ import annotations

import ctypes
import ctypes.util
import io
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import av
import numpy as np

_PIXELS = 1 << 25
_FOREIGN = "Unknown or unsupported tag", "of custom tag"
"""Said of a TIFF; programs may have tags of their own."""


def complaint(path: Path, whole: Path) -> str | None:
    """Return an error that an independent decoder reports for a file, and not for the whole one."""
    for decoder in _DECODERS.get(path.suffix, (_ffmpeg,)):
        said = decoder(path)
        if said is not None and decoder(whole) is None:
            return f"{decoder.__name__.strip('_')}: {said}"
    return None


def _ffmpeg(path: Path) -> str | None:
    av.logging.set_level(av.logging.ERROR)
    av.logging.set_skip_repeated(False)
    with av.logging.Capture() as said:
        try:
            with av.open(str(path)) as container:
                codec: Any = container.streams.video[0].codec_context
                codec.thread_count = 1
                codec.options = {"err_detect": "crccheck+explode", "max_pixels": str(_PIXELS)}
                frames = 0
                for packet in container.demux(container.streams.video[0]):
                    frames += len(codec.decode(packet if packet.size else None))
        except Exception as error:  # noqa: BLE001 - whatever it is, it is an error
            text = f"{type(error).__name__}: {error}"
            return None if any(words in text for words in _FOREIGN) else text
    errors = [text.strip() for level, _, text in said if level <= av.logging.ERROR]
    return errors[0] if errors else None if frames else "no frames"


def _numpy(path: Path) -> str | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            file = io.BytesIO(path.read_bytes())
            array = np.load(file, mmap_mode=None, allow_pickle=False)
            assert isinstance(array, np.ndarray)
    except Exception as error:  # noqa: BLE001 - as above
        return f"{type(error).__name__}: {error}"
    return None


@cache
def _libtiff_library() -> Any:
    name = ctypes.util.find_library("tiff")
    if name is None:
        return None
    library = ctypes.CDLL(name)
    library.TIFFOpen.restype = ctypes.c_void_p
    for function in ("TIFFClose", "TIFFReadDirectory", "TIFFStripSize", "TIFFTileSize"):
        getattr(library, function).argtypes = [ctypes.c_void_p]
    for function in ("TIFFIsTiled", "TIFFNumberOfStrips", "TIFFNumberOfTiles"):
        getattr(library, function).argtypes = [ctypes.c_void_p]
    for function in ("TIFFStripSize", "TIFFTileSize"):
        getattr(library, function).restype = ctypes.c_ssize_t
    for function in ("TIFFReadEncodedStrip", "TIFFReadEncodedTile"):
        getattr(library, function).restype = ctypes.c_ssize_t
        getattr(library, function).argtypes = [
            *(ctypes.c_void_p, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_ssize_t)
        ]
    return library


_SAID: list[str] = []
_HANDLER = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_void_p)


def _note(module: bytes | None, text: bytes, _arguments: Any) -> None:
    said = f"{(module or b'').decode(errors='replace')}: {text.decode(errors='replace')}"
    if not any(words in said for words in _FOREIGN):
        _SAID.append(said)


def _ignore(_module: bytes | None, _text: bytes, _arguments: Any) -> None:
    pass


_NOTE, _IGNORE = _HANDLER(_note), _HANDLER(_ignore)


def _libtiff(path: Path) -> str | None:
    """Return the first error of the system's libtiff; warnings do not count."""
    library = _libtiff_library()
    if library is None:
        return None
    _SAID.clear()
    library.TIFFSetErrorHandler(_NOTE)
    library.TIFFSetWarningHandler(_IGNORE)
    tiff = library.TIFFOpen(str(path).encode(), b"r")
    if not tiff:
        return _SAID[0] if _SAID else "cannot be opened"
    for _ in range(100):
        tiles = library.TIFFIsTiled(tiff)
        size = library.TIFFTileSize(tiff) if tiles else library.TIFFStripSize(tiff)
        count = library.TIFFNumberOfTiles(tiff) if tiles else library.TIFFNumberOfStrips(tiff)
        read = library.TIFFReadEncodedTile if tiles else library.TIFFReadEncodedStrip
        if 0 < size < _PIXELS * 4 and 0 < count < 100_000:
            buffer = ctypes.create_string_buffer(size)
            for number in range(count):
                if read(tiff, number, buffer, size) < 0:
                    break
        if _SAID or not library.TIFFReadDirectory(tiff):
            break
    library.TIFFClose(tiff)
    return _SAID[0] if _SAID else None


_DECODERS: dict[str, tuple[Callable[[Path], str | None], ...]] = {
    ".npy": (_numpy,),
    ".tif": (_libtiff, _ffmpeg),
    ".yaml": (),
    ".npo": (),
}
