"""Files of frames, made by Pillow, NumPy and by hand, for the page and for npchip to read."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, PngImagePlugin

SIZE = 64, 80


def scene(
    rng: np.random.Generator, channels: int = 3, size: tuple[int, int] = SIZE
) -> NDArray[np.uint8]:
    """Return a picture with edges, slopes and noise."""
    rows, cols = np.mgrid[: size[0], : size[1]]
    waves = [
        127 + 120 * np.sin(cols / rng.uniform(2, 15) + rows / rng.uniform(2, 15))
        for _ in range(channels)
    ]
    noisy = np.stack(waves, -1) + rng.normal(0, 9, (*size, channels))
    noisy[10:30, 20:50] = rng.integers(0, 256, channels)
    return noisy.clip(0, 255).astype(np.uint8)


def chunk(kind: bytes, data: bytes) -> bytes:
    """Return a chunk of a PNG."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(
    rng: np.random.Generator, depth: int, colour: int, *, interlaced: bool, extra: bytes = b""
) -> bytes:
    """Return a PNG with any filters, of a kind that Pillow does not write."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    rows, cols = SIZE
    passes = [(0, 0, 1, 1)]
    if interlaced:
        passes = [(0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4)]
        passes += [(2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1)]
    data = b""
    for top, left, down, across in passes:
        height, width = -(-(rows - top) // down), -(-(cols - left) // across)
        for _ in range(height):
            line = rng.integers(0, 256, -(-width * channels * depth // 8), np.uint8)
            data += bytes([int(rng.integers(0, 5))]) + line.tobytes()
    start = struct.pack(">IIBBBBB", cols, rows, depth, colour, 0, 0, interlaced)
    packed = zlib.compress(data)
    cut = len(packed) // 3
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", start)
        + extra
        + chunk(b"IDAT", packed[:cut])
        + chunk(b"IDAT", packed[cut:])
        + chunk(b"IEND", b"")
    )


def pngs(rng: np.random.Generator) -> Iterator[tuple[str, bytes]]:
    """Yield PNGs of every kind of up to 8 bits, with and without what is transparent."""
    depths = {0: (1, 2, 4, 8), 2: (8,), 3: (1, 2, 4, 8), 4: (8,), 6: (8,)}
    gamma = chunk(b"gAMA", struct.pack(">I", 30000))
    for colour, each in depths.items():
        for depth in each:
            colours = rng.integers(0, 256, 3 * (1 << depth), np.uint8).tobytes()
            palette = chunk(b"PLTE", colours) if colour == 3 else b""
            alphas = rng.integers(0, 256, 1 << depth, np.uint8).tobytes()
            holes = {
                0: struct.pack(">H", int(rng.integers(0, 1 << depth))),
                2: struct.pack(">3H", *rng.integers(0, 256, 3).tolist()),
                3: alphas[: 1 + len(alphas) // 2],
            }
            for interlaced in (False, True):
                name = f"c{colour}d{depth}i{int(interlaced)}"
                yield name, png(rng, depth, colour, interlaced=interlaced, extra=gamma + palette)
                if colour in holes:
                    extra = palette + chunk(b"tRNS", holes[colour])
                    yield f"{name}t", png(rng, depth, colour, interlaced=interlaced, extra=extra)
    holes_one = chunk(b"PLTE", bytes(range(96))) + chunk(b"tRNS", b"\xff\xff\0\xff")
    yield "one_hole", png(rng, 4, 3, interlaced=False, extra=holes_one)
    yield "deep", png(rng, 16, 2, interlaced=False)
    yield "deep_grey", png(rng, 16, 0, interlaced=False)


def saved(image: Image.Image, kind: str, **options: Any) -> bytes:
    """Return an image as the bytes of a file."""
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()


def exif(orientation: int) -> bytes:
    """Return EXIF data with an orientation."""
    data = Image.Exif()
    data[0x0112] = orientation
    return data.tobytes()


def profile() -> bytes:
    """Return a colour profile that would change every colour if it were applied."""
    return ImageCms.ImageCmsProfile(ImageCms.createProfile("XYZ")).tobytes()


def pictures(rng: np.random.Generator) -> Iterator[tuple[str, bytes]]:
    """Yield images that Pillow writes, by names with suffixes."""
    colour, grey = Image.fromarray(scene(rng)), Image.fromarray(scene(rng, 1)[..., 0])
    clear = Image.fromarray(scene(rng, 4), "RGBA")
    for mode in ("1", "L", "LA", "P", "RGB", "RGBA"):
        yield f"{mode}.png", saved(clear.convert(mode), "PNG")
    info = PngImagePlugin.PngInfo()
    info.add(b"gAMA", struct.pack(">I", 100000))
    yield "profile.png", saved(colour, "PNG", icc_profile=profile(), pnginfo=info)
    for subsampling in (0, 1, 2):
        for quality in (30, 90):
            options = {"quality": quality, "subsampling": subsampling}
            yield f"s{subsampling}q{quality}.jpg", saved(colour, "JPEG", **options)
    yield "grey.jpg", saved(grey, "JPEG")
    yield "progressive.jpg", saved(colour, "JPEG", progressive=True, icc_profile=profile())
    yield "restarts.jpg", saved(colour, "JPEG", restart_marker_blocks=3)
    yield "cmyk.jpg", saved(colour.convert("CMYK"), "JPEG")
    for orientation in range(1, 9):
        turned = colour.transpose(Image.Transpose.TRANSPOSE) if orientation > 4 else colour
        for kind in ("jpg", "png", "webp"):
            written = "JPEG" if kind == "jpg" else kind.upper()
            yield f"turned{orientation}.{kind}", saved(turned, written, exif=exif(orientation))
    for mode in ("RGB", "RGBA"):
        yield f"{mode}.webp", saved(clear.convert(mode), "WEBP", quality=70)
        yield f"{mode}_lossless.webp", saved(clear.convert(mode), "WEBP", lossless=True)
    yield "profile.webp", saved(colour, "WEBP", icc_profile=profile())
    for mode in ("1", "L", "P", "RGB", "RGBA"):
        yield f"{mode}.bmp", saved(clear.convert(mode), "BMP")
    for mode in ("1", "L", "RGB"):
        yield f"{mode}.ppm", saved(colour.convert(mode), "PPM")
    yield "adaptive.gif", saved(colour.convert("P", palette=Image.Palette.ADAPTIVE), "GIF")
    yield "grey.gif", saved(grey, "GIF", interlace=True)


def bmp(rng: np.random.Generator, bits: int, header: int = 40, *, alpha: int | None = 0) -> bytes:
    """Return a BMP of a kind that Pillow does not write; random alpha if `alpha` is None."""
    rows, cols = SIZE
    pixels = rng.integers(0, 256, (rows, -(-cols * bits // 32) * 4), np.uint8)
    if bits == 32 and alpha is not None:
        pixels[:, 3::4] = alpha
    colours = rng.integers(
        0, 256, (1 << bits if bits <= 8 else 0, 3 if header == 12 else 4), np.uint8
    )
    if header == 12:
        head = struct.pack("<IHHHH", header, cols, rows, 1, bits)
    else:
        masks = header > 40 and bits == 32
        sizes = (3 if masks else 0, pixels.size, 2835, 2835, 0, 0)
        head = struct.pack("<IiiHHIIiiII", header, cols, rows, 1, bits, *sizes)
        if masks:
            head += struct.pack("<4I", 0xFF0000, 0xFF00, 0xFF, 0xFF000000)
        head = head.ljust(header, b"\0")
    start = 14 + header + colours.size
    stated = struct.pack("<IHHI", start + pixels.size, 0, 0, start)
    return b"BM" + stated + head + colours.tobytes() + pixels.tobytes()


def bmps(rng: np.random.Generator) -> Iterator[tuple[str, bytes]]:
    """Yield BMPs of each depth, old and new, with and without what is transparent."""
    for bits in (1, 4, 8, 24):
        for header in (12, 40, 108):
            yield f"h{header}d{bits}.bmp", bmp(rng, bits, header)
    yield "h40d32.bmp", bmp(rng, 32)
    for header in (56, 108, 124):
        yield f"clear{header}.bmp", bmp(rng, 32, header, alpha=None)
    yield "tail.bmp", bmp(rng, 24) + b"tail"


def animations(rng: np.random.Generator) -> Iterator[tuple[str, bytes]]:
    """Yield animations that Pillow writes."""
    for mode in ("P", "L", "RGBA"):
        frames = [Image.fromarray(scene(rng, 4), "RGBA").convert(mode) for _ in range(4)]
        for disposal in (0, 1, 2, 3):
            options: dict[str, Any] = {"save_all": True, "append_images": frames[1:]}
            options |= {"duration": 40, "disposal": disposal}
            yield f"{mode}{disposal}.gif", saved(frames[0], "GIF", **options)
    holes = [Image.fromarray(spotted(rng), "RGBA") for _ in range(5)]
    for disposal in (0, 1, 2):
        for blend in (0, 1):
            options = {"save_all": True, "append_images": holes[1:]}
            options |= {"disposal": disposal, "blend": blend}
            yield f"{disposal}{blend}.png", saved(holes[0], "PNG", **options)
            yield f"{disposal}{blend}d.png", saved(holes[0], "PNG", **options, default_image=True)
    for lossless in (False, True):
        options = {"save_all": True, "append_images": holes[1:], "lossless": lossless}
        yield f"holes{int(lossless)}.webp", saved(holes[0], "WEBP", **options, allow_mixed=False)
        plain = [image.convert("RGB") for image in holes]
        options["append_images"] = plain[1:]
        yield f"plain{int(lossless)}.webp", saved(plain[0], "WEBP", **options)


def spotted(rng: np.random.Generator) -> NDArray[np.uint8]:
    """Return a picture of colours with alpha: clear, opaque and between."""
    picture = scene(rng, 4)
    top, left = rng.integers(0, 40, 2)
    picture[..., 3] = 0
    picture[top : top + 24, left : left + 30, 3] = 255
    picture[top + 4 : top + 9, left : left + 9, 3] = 90
    return picture


def write(folder: Path, files: Iterator[tuple[str, bytes]]) -> list[Path]:
    """Write files to a folder; names without suffix are PNGs."""
    paths = []
    for name, data in files:
        path = folder / (name if "." in name else f"{name}.png")
        path.write_bytes(data)
        paths.append(path)
    return paths
