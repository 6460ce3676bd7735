"""From picture files to positions, with a trained network."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Final, Literal, get_args

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
"""Yaw, anticlockwise from the x axis as seen from above, and pitch, in degrees."""

Yaw = Literal["x-axis", "compass"]
YAWS: Final[tuple[Yaw, ...]] = get_args(Yaw)
"""Conventions of a yaw: anticlockwise from the x axis, or clockwise from north, the y axis."""


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


def check_direction(yaw: float, pitch: float, where: str, kind: Yaw = "x-axis") -> Direction:
    """Convert a direction, and refuse one that no camera above the floor has.

    Args:
        yaw: direction in which the camera looks, in degrees.
        pitch: -90 straight down, 0 level.
        where: where it stands, for messages.
        kind: what the yaw counts from.

    Raises:
        InputError: NP457.
    """
    if not -360 <= yaw <= 360 or not -90 <= pitch <= 0:
        counted = "clockwise from north (+y)" if kind == "compass" else "anticlockwise from +x"
        raise InputError(
            "NP457",
            f"{where}: yaw {yaw:g}, pitch {pitch:g}: expected a yaw of -360 to 360 degrees,"
            f" {counted}, and a pitch of -90 (straight down) to 0 (level)",
            hint="--yaw-from says which of the two",
        )
    return (90 - yaw if kind == "compass" else yaw), pitch


def read_angles(path: Path, kind: Yaw = "x-axis") -> dict[str, Direction]:
    """Read a CSV file with the columns ``name``, ``yaw`` and ``pitch``, and any others.

    Args:
        path: the file.
        kind: what the yaws count from.

    Raises:
        InputError: NP457, it cannot be read, a line is wrong, or two are for one picture.
    """
    try:
        text = read_bytes(path, _MOST_BYTES).decode("utf-8-sig")
        with io.StringIO(text, newline="") as file:
            lines = csv.reader(file, strict=True)
            places = _columns(next(lines, []), path)
            found: dict[str, tuple[int, Direction]] = {}
            for cells in filter(None, lines):
                where = f"{path}, line {lines.line_num}"
                name, direction = _angles(cells, places, where, kind)
                if name in found:
                    raise InputError(
                        "NP457",
                        f"{where}: {name} has a second line; the first is line {found[name][0]}",
                        hint="which of them is right? Remove the other",
                    )
                found[name] = lines.line_num, direction
            return {name: direction for name, (_, direction) in found.items()}
    except OSError as error:
        raise InputError("NP457", f"cannot read {path}: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            "NP457", f"{path}: not a text of comma-separated values: {error}"
        ) from None


@dataclass(frozen=True)
class _Columns:
    """Number of all columns, and places of those that are read."""

    count: int
    places: tuple[int, ...]


def _columns(head: list[str], path: Path) -> _Columns:
    names = [name.strip() for name in head]
    wanted = ("name", "yaw", "pitch")
    missing = [name for name in wanted if name not in names]
    if missing:
        raise InputError(
            "NP457",
            f"{path}: no column {', '.join(missing)}",
            hint="the first line has to be: name,yaw,pitch",
        )
    for name in wanted:
        if names.count(name) > 1:
            raise InputError(
                "NP457",
                f"{path}, line 1: {names.count(name)} columns have the name {name}",
                hint="which of them is right? Rename the other",
            )
    return _Columns(len(names), tuple(map(names.index, wanted)))


def _angles(cells: list[str], columns: _Columns, where: str, kind: Yaw) -> tuple[str, Direction]:
    if len(cells) != columns.count:
        raise InputError(
            "NP457",
            f"{where}: expected {columns.count} fields as in the first line, found {len(cells)}",
            hint="numbers have a decimal point; a comma ends a field",
        )
    name, *texts = (cells[place].strip() for place in columns.places)
    try:
        if not all(text.isascii() and "_" not in text for text in texts):
            raise ValueError  # noqa: TRY301 - what float takes and no table means
        yaw, pitch = map(float, texts)
    except ValueError:
        raise InputError(
            "NP457",
            f"{where}: yaw {texts[0] or 'missing'}, pitch {texts[1] or 'missing'}:"
            " expected numbers, such as 45.5",
            hint="numbers have a decimal point, no decimal comma",
        ) from None
    if not name:
        raise InputError("NP457", f"{where}: the name of the picture is missing")
    return name, check_direction(yaw, pitch, where, kind)
