"""Data sets: camera positions and the vertices found in their pictures, with their settings."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final, Literal, get_args

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import open_input, write_bytes
from npchip.base.json import one_line
from npchip.host.vision.orientation.corners import THRESHOLD, corner_pixels
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import THESIS, Camera, Floats, project, random_positions

Source = Literal["rendered", "rounded", "exact"]
SOURCES: Final[tuple[Source, ...]] = get_args(Source)

SCHEMA: Final = 2
_CORNERS: Final = 1
"""The schema whose whole numbers were corners of pixels, not middles."""
MOST_POSES: Final = 100_000
_BATCH: Final = 500
_MOST_BYTES: Final = 1 << 26


@dataclass(frozen=True)
class Settings:
    """Settings that determine a data set.

    Attributes:
        poses: number of camera positions.
        seed: seed of the positions.
        source: source of the vertices: key points of ``rendered`` pictures, ``exact`` projection,
            or projection ``rounded`` to the centre of the pixel.
        camera: frame and focal length.

    Raises:
        InputError: NP453, a setting out of range.
    """

    poses: int = 4_000
    seed: int = 1
    source: Source = "rendered"
    camera: Camera = THESIS

    def __post_init__(self) -> None:
        """Check the settings; see the class."""
        if not 20 <= self.poses <= MOST_POSES:
            raise InputError(
                "NP453", f"a data set has 20 to {MOST_POSES:,} poses, found {self.poses:,}"
            )
        if self.source not in SOURCES:
            raise InputError("NP453", f"vertices are {', '.join(SOURCES)}, found {self.source!r}")
        if not 0 <= self.seed < 2**32:
            raise InputError("NP453", f"a seed is 0 to 2**32 - 1, found {self.seed}")


@dataclass(frozen=True, eq=False)
class DataSet:
    """Positions of a camera and the vertices in its pictures.

    Attributes:
        settings: the settings that determine it.
        positions: positions of the camera, float64, shape (N, 3), in mm.
        vertices: row and column of the three vertices in the picture, the highlighted one first,
            float64, shape (N, 3, 2); whole numbers are middles of pixels.
    """

    settings: Settings
    positions: Floats
    vertices: Floats

    def __len__(self) -> int:
        return len(self.positions)


def make(settings: Settings, progress: Callable[[int], None] = lambda _: None) -> DataSet:
    """Make a data set; the same settings give the same one.

    Args:
        settings: the settings.
        progress: called now and then with the number of finished poses.
    """
    camera = settings.camera
    positions = random_positions(settings.poses, settings.seed, camera)
    places = project(positions, camera=camera)
    if settings.source == "rounded":
        places = np.rint(places)
    elif settings.source == "rendered":
        for first in range(0, len(positions), _BATCH):
            pictures = render(positions[first : first + _BATCH], camera)
            for number, picture in enumerate(pictures, first):
                points = corner_pixels(picture, THRESHOLD)
                assert points is not None, "the whole triangle is in the picture"
                places[number] = points
            progress(first + len(pictures))
    return DataSet(settings, positions, places)


def save(path: Path, data: DataSet) -> None:
    """Write a data set as ``.npz``, whole or not at all.

    Raises:
        InputError: NP250, it cannot be written.
    """
    buffer = io.BytesIO()
    document = one_line({"schema": SCHEMA, **asdict(data.settings)})
    np.savez_compressed(
        buffer, settings=np.array(document), positions=data.positions, vertices=data.vertices
    )
    write_bytes(path, buffer.getvalue())


def load(path: Path) -> DataSet:
    """Read a data set that `save` wrote; nothing in it is executed.

    Raises:
        InputError: NP454, it is not a data set.
    """
    try:
        with open_input(path) as file:
            with zipfile.ZipFile(file) as packed:
                if sum(part.file_size for part in packed.infolist()) > _MOST_BYTES:
                    raise ValueError(f"more than {_MOST_BYTES >> 20} MiB")  # noqa: TRY301
            file.seek(0)
            with np.load(file, allow_pickle=False) as archive:
                document = json.loads(str(archive["settings"]))
                positions, vertices = archive["positions"], archive["vertices"]
        return _checked(document, positions, vertices)
    except OSError as error:
        raise InputError("NP454", f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:  # noqa: BLE001 - readers of damaged archives raise anything
        raise InputError(
            "NP454",
            f"{path}: not a data set of npchip orient: {error}",
            hint="npchip orient train --save-data FILE.npz writes one",
        ) from None


def _checked(document: dict[str, Any], positions: Any, vertices: Any) -> DataSet:
    schema = document.pop("schema")
    if schema not in (_CORNERS, SCHEMA):
        raise ValueError(f"expected schema {SCHEMA}")
    settings = Settings(**{**document, "camera": Camera(**document["camera"])})
    shapes = (settings.poses, 3), (settings.poses, 3, 2)
    if (positions.shape, vertices.shape) != shapes:
        raise ValueError(f"arrays of {positions.shape} and {vertices.shape}, expected {shapes}")
    if not (np.isfinite(positions).all() and np.isfinite(vertices).all()):
        raise ValueError("numbers that are not finite")
    places = vertices.astype(np.float64) - (0.5 if schema == _CORNERS else 0)
    return DataSet(settings, positions.astype(np.float64), places)
