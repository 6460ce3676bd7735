"""Whole files to damage, several of each format."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image

from npchip.assembler import assemble
from npchip.formats.npo import to_text
from npchip.isa import load_isa

ROOT = Path(__file__).parents[2]
SIZE = (64, 80)


@cache
def bases(form: str) -> tuple[tuple[str, bytes], ...]:
    """Return names, whose suffix tells the format, and contents of whole files."""
    return tuple(_FORMS[form]())


def _clip(*shape: int) -> NDArray[np.uint8]:
    """Return pictures that compress, and differ."""
    rng = np.random.default_rng(len(shape))
    steps = rng.integers(-9, 10, (*shape[:1], *SIZE, *shape[1:]))
    clip: NDArray[np.uint8] = np.clip(128 + steps.cumsum(axis=2) // 2, 0, 255).astype(np.uint8)
    return clip


def _image(picture: NDArray[Any], kind: str, mode: str | None = None, **how: Any) -> bytes:
    """Return a picture as Pillow saves it."""
    file = io.BytesIO()
    image = Image.fromarray(picture)
    (image.convert(mode) if mode else image).save(file, kind, **how)
    return file.getvalue()


def _animation(clip: NDArray[Any], kind: str, **how: Any) -> bytes:
    first, *others = map(Image.fromarray, clip)
    file = io.BytesIO()
    first.save(file, kind, save_all=True, append_images=others, duration=50, **how)
    return file.getvalue()


def _arrays() -> Iterator[tuple[str, bytes]]:
    clip = _clip(3)
    for name, array in (
        ("bytes", clip),
        ("one", clip[0]),
        ("wide", clip.astype(np.int64)),
        ("big-endian", clip.astype(">u2")),
        ("fortran", np.asfortranarray(clip)),
    ):
        file = io.BytesIO()
        np.save(file, array)
        yield f"{name}.npy", file.getvalue()
    file = io.BytesIO()
    np.save(file, np.ascontiguousarray(clip[:2, :8, :10]))
    yield "memory-planes.npy", file.getvalue()
    file = io.BytesIO()
    np.lib.format.write_array(file, clip, version=(3, 0))
    yield "new.npy", file.getvalue()


def _png() -> Iterator[tuple[str, bytes]]:
    grey, colour, alpha = _clip(1)[0], _clip(1, 3)[0], _clip(1, 4)[0]
    yield "grey.png", _image(grey, "PNG")
    yield "colour.png", _image(colour, "PNG")
    yield "alpha.png", _image(alpha, "PNG")
    yield "palette.png", _image(colour, "PNG", "P")
    yield "bits.png", _image(grey, "PNG", "1")
    yield "stored.png", _image(grey, "PNG", compress_level=0)
    yield "deep.png", _image(grey.astype(np.uint16) << 8, "PNG")


def _apng() -> Iterator[tuple[str, bytes]]:
    yield "grey.png", _animation(_clip(4), "PNG")
    yield "colour.png", _animation(_clip(3, 3), "PNG", disposal=1)
    yield "alpha.png", _animation(_clip(3, 4), "PNG", blend=1)
    yield "default.png", _animation(_clip(4), "PNG", default_image=True)


def _jpeg() -> Iterator[tuple[str, bytes]]:
    grey, colour = _clip(1)[0], _clip(1, 3)[0]
    yield "grey.jpg", _image(grey, "JPEG", quality=90)
    yield "colour.jpg", _image(colour, "JPEG", quality=90)
    yield "full.jpg", _image(colour, "JPEG", quality=60, subsampling=0)
    yield "progressive.jpg", _image(colour, "JPEG", progressive=True, quality=85)
    yield "progressive_grey.jpg", _image(grey, "JPEG", progressive=True, quality=85)
    yield "optimised.jpg", _image(colour, "JPEG", optimize=True)
    yield "restart.jpg", _image(colour, "JPEG", restart_marker_blocks=3)
    yield "cmyk.jpg", _image(colour, "JPEG", "CMYK")


def _gif() -> Iterator[tuple[str, bytes]]:
    yield "grey.gif", _image(_clip(1)[0], "GIF")
    yield "colour.gif", _image(_clip(1, 3)[0], "GIF")
    yield "interlaced.gif", _image(_clip(1)[0], "GIF", interlace=1)
    yield "several.gif", _animation(_clip(4), "GIF")
    yield "several_colour.gif", _animation(_clip(3, 3), "GIF", disposal=2)


def _bmp() -> Iterator[tuple[str, bytes]]:
    yield "grey.bmp", _image(_clip(1)[0], "BMP")
    yield "colour.bmp", _image(_clip(1, 3)[0], "BMP")
    yield "palette.bmp", _image(_clip(1, 3)[0], "BMP", "P")
    yield "bits.bmp", _image(_clip(1)[0], "BMP", "1")
    yield "alpha.bmp", _image(_clip(1, 4)[0], "BMP")
    # Runs of one colour, each row for itself.
    rows = b"".join(
        b"".join(bytes([8, value // 20 * 20]) for value in row[::8]) + b"\0\0"
        for row in _clip(1)[0][::-1]
    )
    head = struct.pack("<IiiHHIIiiII", 40, 80, 64, 1, 8, 1, len(rows) + 2, 0, 0, 256, 0)
    colours = b"".join(bytes([value, value, value, 0]) for value in range(256))
    body = head + colours + rows + b"\0\1"
    start = struct.pack("<2sIHHI", b"BM", 14 + len(body), 0, 0, 14 + len(head) + len(colours))
    yield "runs.bmp", start + body


def _webp() -> Iterator[tuple[str, bytes]]:
    yield "lossless.webp", _image(_clip(1, 3)[0], "WEBP", lossless=True)
    yield "lossy.webp", _image(_clip(1, 3)[0], "WEBP")
    yield "alpha.webp", _image(_clip(1, 4)[0], "WEBP")
    yield "several.webp", _animation(_clip(3, 3), "WEBP")
    yield "several_lossless.webp", _animation(_clip(3, 3), "WEBP", lossless=True)


def _portable() -> Iterator[tuple[str, bytes]]:
    grey, colour = _clip(1)[0], _clip(1, 3)[0]
    yield "grey.pgm", _image(grey, "PPM")
    yield "colour.ppm", _image(colour, "PPM")
    yield "bits.pbm", _image(grey, "PPM", "1")
    yield "several.pgm", b"".join(_image(picture, "PPM") for picture in _clip(3))
    yield "text.pgm", b"P2\n80 64\n255\n" + b" ".join(b"%d" % value for value in grey.ravel())
    yield "levels.pgm", b"P5\n80 64\n100\n" + bytes(np.minimum(grey, 100).ravel())


def _tiff() -> Iterator[tuple[str, bytes]]:
    grey, colour = _clip(1)[0], _clip(1, 3)[0]
    yield "grey.tif", _image(grey, "TIFF")
    yield "colour.tif", _image(colour, "TIFF")
    for way in ("tiff_lzw", "tiff_adobe_deflate", "packbits", "jpeg"):
        yield f"{way}.tif", _image(colour, "TIFF", compression=way)
    for way in ("zstd", "lzma"):
        found: list[tuple[str, bytes]] = []
        with suppress(OSError):  # Pillow 10.3 cannot write all of them
            found.append((f"{way}.tif", _image(colour, "TIFF", compression=way)))
        yield from found
    yield "grey_jpeg.tif", _image(grey, "TIFF", compression="jpeg")
    yield "fax.tif", _image(grey, "TIFF", "1", compression="group4")
    yield "several.tif", _animation(_clip(3), "TIFF", compression="tiff_lzw")
    for name, how in (
        ("tiles", {"tile": (16, 16)}),
        ("big", {"bigtiff": True}),
        ("endian", {"byteorder": ">"}),
        ("strips", {"rowsperstrip": 5, "compression": "zlib", "predictor": True}),
        ("stack", {"photometric": "minisblack"}),
    ):
        file = io.BytesIO()
        tifffile.imwrite(file, _clip(3) if name == "stack" else grey, **how)
        yield f"{name}.tif", file.getvalue()


def _yaml() -> Iterator[tuple[str, bytes]]:
    package = ROOT / "src" / "npchip"
    for path in (package / "machine" / "default.yaml", package / "machine" / "conservative.yaml"):
        yield f"machine-{path.name}", path.read_bytes()
    yield "isa-npchip.yaml", (package / "isa" / "npchip.yaml").read_bytes()
    for name in ("space-bouncing.yaml", "space-circular.yaml"):
        yield name, (ROOT / "examples" / "scenes" / name).read_bytes()
    yield "scene-three.yaml", (ROOT / "examples" / "scenes" / "three.yaml").read_bytes()
    yield "rig-thesis.yaml", (ROOT / "examples" / "rigs" / "thesis.yaml").read_bytes()


def _objects() -> Iterator[tuple[str, bytes]]:
    for name in ("trajectory", "edges"):
        program = assemble(ROOT / "asm" / f"{name}.s")
        yield f"{name}.npo", to_text(program, load_isa()).encode()


_FORMS = {
    "npy": _arrays,
    "png": _png,
    "apng": _apng,
    "jpeg": _jpeg,
    "gif": _gif,
    "bmp": _bmp,
    "webp": _webp,
    "pgm": _portable,
    "tiff": _tiff,
    "yaml": _yaml,
    "npo": _objects,
}
FORMS = tuple(_FORMS)
