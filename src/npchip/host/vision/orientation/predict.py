"""From picture files to positions, with a trained network."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np
from natsort import natsorted
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import read_bytes
from npchip.frames import open_frames
from npchip.frames.open import IMAGES
from npchip.host.vision.orientation import models
from npchip.host.vision.orientation.corners import THRESHOLD, vertices
from npchip.host.vision.orientation.models import MODELS, Estimator
from npchip.host.vision.orientation.scene import Floats, spherical

_MOST_BYTES = 1 << 24  # of a table of angles

Picture = NDArray[np.uint8]
Direction = tuple[float, float]
"""Yaw and pitch, in degrees."""


@dataclass(frozen=True)
class Estimate:
    """Estimate for a picture.

    Attributes:
        name: name of the picture.
        position: position of the camera, shape (3,), in mm; None after an error.
        error: the error.
    """

    name: str
    position: Floats | None
    error: InputError | None = None

    @property
    def spherical(self) -> tuple[float, float, float]:
        """Radial distance in mm, polar and azimuth angle in degrees."""
        assert self.position is not None
        radial, polar, azimuth = spherical(self.position[np.newaxis])[0]
        return float(radial), float(np.degrees(polar)), float(np.degrees(azimuth))


def bundled(model: str, size: str) -> Estimator:
    """Load a network of the package: ``hybrid`` or ``vertices``, for ``100x100`` or ``64x80``."""
    place = resources.files("npchip.host.vision.orientation") / "trained" / f"{model}-{size}.json"
    with resources.as_file(place) as path:
        return models.load(path)


def pictures(source: Path) -> list[Path]:
    """Return the image files of a path: itself, or those of a folder in natural order.

    Raises:
        InputError: NP458, there is no such path, or no image in the folder.
    """
    if not source.is_dir():
        if not source.exists():
            raise InputError("NP458", f"{source}: no such file or folder")
        return [source]
    found = [path for path in source.iterdir() if path.suffix.lower() in IMAGES]
    if not found:
        raise InputError("NP458", f"{source}: holds no images", hint=f"expected {' '.join(IMAGES)}")
    return natsorted(sorted(found), key=str)


def predict(
    estimator: Estimator,
    files: list[Path],
    directions: Mapping[str, Direction] | Direction | None = None,
    *,
    threshold: int = THRESHOLD,
) -> list[Estimate]:
    """Estimate the positions of the camera; a picture with an error does not stop the others.

    Args:
        estimator: a trained model.
        files: pictures of the size of its camera; a ``.npy`` file may hold several.
        directions: yaw and pitch of all pictures, or by file name, if the model needs them.
        threshold: least level of an object pixel.

    Raises:
        InputError: NP457, the model needs directions and there are none.
    """
    directed = MODELS[estimator.model].directed
    if directed and directions is None:
        raise InputError(
            "NP457",
            f"model {estimator.model} needs yaw and pitch of the camera",
            hint="give --yaw and --pitch, or --angles FILE.csv; model vertices needs neither",
        )
    estimates: list[Estimate] = []
    found: list[tuple[int, Floats, Direction]] = []
    for file in files:
        for name, picture in _read(file, estimator):
            try:
                if isinstance(picture, InputError):
                    raise picture
                direction = _direction(directions, file.name) if directed else (0.0, 0.0)
                found.append((len(estimates), vertices(picture, threshold, name), direction))
                estimates.append(Estimate(name, None))
            except InputError as error:
                estimates.append(Estimate(name, None, error))
    if found:
        numbers, seen, angles = zip(*found, strict=True)
        positions = estimator(np.array(seen), np.array(angles) if directed else None)
        for number, position in zip(numbers, positions, strict=True):
            estimates[number] = Estimate(estimates[number].name, position)
    return estimates


def _read(file: Path, estimator: Estimator) -> Iterator[tuple[str, Picture | InputError]]:
    """Yield the name of each picture with its frame or its error."""
    camera, name = estimator.camera, str(file)
    try:
        source = open_frames(file, camera.rows, camera.cols)
        for number, frame in enumerate(source):
            name = str(file) if source.count == 1 else f"{file}, frame {number}"
            yield name, frame
    except InputError as error:
        if error.code == "NP217":
            error.hint = "give --size or a --network of this size; pictures are not scaled"
        yield name, error


def _direction(directions: Mapping[str, Direction] | Direction | None, name: str) -> Direction:
    if isinstance(directions, Mapping):
        if name not in directions:
            raise InputError("NP457", f"{name}: the file of angles has no line for it")
        return directions[name]
    assert directions is not None
    return directions


def check_direction(yaw: float, pitch: float, where: str) -> Direction:
    """Refuse a direction that no camera above the floor has.

    Raises:
        InputError: NP457.
    """
    if not -360 <= yaw <= 360 or not -90 <= pitch <= 0:
        raise InputError(
            "NP457",
            f"{where}: yaw {yaw:g}, pitch {pitch:g}: expected a yaw of -360 to 360 degrees and a"
            " pitch of -90 (straight down) to 0 (level)",
        )
    return yaw, pitch


def read_angles(path: Path) -> dict[str, Direction]:
    """Read a CSV file with the columns ``name``, ``yaw`` and ``pitch``, and any others.

    Raises:
        InputError: NP457, it cannot be read, or a line is wrong.
    """
    try:
        text = read_bytes(path, _MOST_BYTES).decode("utf-8-sig")
        with io.StringIO(text, newline="") as file:
            lines = csv.DictReader(file)
            missing = {"name", "yaw", "pitch"} - set(lines.fieldnames or ())
            if missing:
                raise InputError(
                    "NP457",
                    f"{path}: no column {', '.join(sorted(missing))}",
                    hint="the first line has to be: name,yaw,pitch",
                )
            return {str(line["name"]): _angles(line, path, lines.line_num) for line in lines}
    except OSError as error:
        raise InputError("NP457", f"cannot read {path}: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            "NP457", f"{path}: not a text of comma-separated values: {error}"
        ) from None


def _angles(line: Mapping[str, str | None], path: Path, number: int) -> Direction:
    where = f"{path}, line {number}"
    texts = [line[key] or "" for key in ("yaw", "pitch")]
    try:
        yaw, pitch = (float(text if text.isascii() else "") for text in texts)
    except ValueError:
        raise InputError(
            "NP457", f"{where}: yaw {line['yaw']}, pitch {line['pitch']}: expected numbers"
        ) from None
    return check_direction(yaw, pitch, where)
