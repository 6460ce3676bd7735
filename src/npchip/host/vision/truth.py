"""Score places and predictions against a truth file: where objects really are.

Never score by the next *measured* place: a box that is always the whole frame would be perfect.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

MOVED: Final = 0.6
"""An object moves where its places differ by as many pixels along an axis ..."""
AROUND: Final = 3
"""... within as many frames before and after."""

NEAR: Final = 6
"""Pixels between an object and what may be it."""

Places = NDArray[np.float64]


@dataclass(frozen=True)
class Score:
    """Errors of a program that follows an object; lengths in pixels, NaN where no frame counts.

    Attributes:
        valid: share of the frames with a moving object in which the program sees one; without
            any moving object, of all frames.
        rms: root mean square distance of the prediction from the object's true place.
        median: median distance.
        stays_rms: the same for the last place seen: the object stays where it is.
        stays_median: median for it.
    """

    valid: float
    rms: float
    median: float
    stays_rms: float
    stays_median: float


def read_truth(path: Path) -> dict[str, dict[int, Places]]:
    """Read the true places of a clip's objects.

    Args:
        path: JSON with ``objects``: by name, the first frame ``start`` and ``points``, a row and
            a column for each frame from there on, or null where the object is not there.

    Returns:
        By name and frame, the row and the column.
    """
    objects = json.loads(path.read_text(encoding="utf-8"))["objects"]
    return {
        name: {
            frame: np.array(point, np.float64)
            for frame, point in enumerate(track["points"], track["start"])
            if point is not None
        }
        for name, track in objects.items()
    }


def places_of(outputs: Mapping[str, NDArray[np.int32]]) -> tuple[Places, Places]:
    """Give the measured and the predicted places of any program that follows one object.

    Args:
        outputs: by name: ``valid``; ``row`` and ``col``, with ``row_sub`` and ``col_sub`` if there
            are, or ``center_row`` and ``center_col``; ``predicted_row`` and ``predicted_col`` if
            there are. A program without them predicts that the object stays.

    Returns:
        float64, shape (T, 2) each, NaN in frames that are not valid.
    """
    seen = np.asarray(outputs["valid"]) > 0
    prefix = "" if "row" in outputs else "center_"
    measured = np.stack(
        [
            np.asarray(outputs[prefix + axis], np.float64)
            + np.asarray(outputs.get(axis + "_sub", 0)) / 256
            for axis in ("row", "col")
        ],
        axis=1,
    )
    predicted = measured.copy()
    if "predicted_row" in outputs:
        for axis, name in enumerate(("predicted_row", "predicted_col")):
            predicted[:, axis] = outputs[name]
    measured[~seen] = predicted[~seen] = np.nan
    return measured, predicted


def score(
    objects: Mapping[str, Mapping[int, Places]], measured: Places, predicted: Places, ahead: int = 1
) -> Score:
    """Compare predictions with the true places ``ahead`` frames later.

    The object that a program follows is the one nearest to its last measured place. Frames count
    from the first measurement on, where some object moves and the followed one is still there
    ``ahead`` frames later; a frame without a measurement counts with the last place.
    """
    frames = range(len(measured))
    moving = [any(_moves(track, frame) for track in objects.values()) for frame in frames]
    counted = [frame for frame in frames if moving[frame]] or list(frames)
    seen = ~np.isnan(measured[:, 0])
    ahead_errors, stays_errors = [], []
    last, followed = np.zeros(2), ""
    for frame in frames:
        if seen[frame]:
            there = [name for name in objects if frame in objects[name]]
            last = measured[frame]
            if there:
                followed = min(there, key=lambda name: _distance(objects[name][frame], last))
        if not moving[frame] or not followed or frame + ahead not in objects[followed]:
            continue
        true = objects[followed][frame + ahead]
        ahead_errors.append(_distance(true, predicted[frame] if seen[frame] else last))
        stays_errors.append(_distance(true, last))
    return Score(float(seen[counted].mean()), *_summary(ahead_errors), *_summary(stays_errors))


@dataclass(frozen=True)
class ManyScore:
    """Errors of a program that follows several objects; lengths in pixels, NaN where none is seen.

    Attributes:
        seen: share of the frames of all objects in which the object is seen.
        switches: how often an object is seen with another identity than before.
        rms: root mean square distance of the predictions from the objects' true places.
        median: median distance.
        stays_rms: the same for the measured places: objects stay where they are.
        stays_median: median for it.
    """

    seen: float
    switches: int
    rms: float
    median: float
    stays_rms: float
    stays_median: float


class Entry(NamedTuple):
    """An object as a program sees it: the number of its track, and two places, float64."""

    track: int
    measured: Places
    predicted: Places


def entries_of(outputs: Mapping[str, Sequence[Sequence[int] | None]]) -> list[list[Entry]]:
    """Give what a program sees in each frame.

    Args:
        outputs: by name and frame, lists ``id``, ``row``, ``col``, ``predicted_row`` and
            ``predicted_col``; None where nothing is seen. Lists such as ``row_high`` have the
            high bytes of others, if there are any.
    """
    names = ("id", "row", "col", "predicted_row", "predicted_col")
    frames = zip(*(_whole(outputs, name) for name in names), strict=True)
    return [
        [
            Entry(int(track), np.array(place[:2], np.float64), np.array(place[2:], np.float64))
            for track, *place in zip(*(() if one is None else one for one in lists), strict=True)
        ]
        for lists in frames
    ]


def _whole(
    outputs: Mapping[str, Sequence[Sequence[int] | None]], name: str
) -> Sequence[Sequence[int] | None]:
    """Give an output with its high bytes."""
    low, high = outputs[name], outputs.get(f"{name}_high")
    if high is None:
        return low
    return [
        None if one is None else [a | b << 8 for a, b in zip(one, other or (), strict=True)]
        for one, other in zip(low, high, strict=True)
    ]


def score_many(
    objects: Mapping[str, Mapping[int, Places]], entries: Sequence[Sequence[Entry]], ahead: int = 1
) -> ManyScore:
    """Compare what is seen with the true places, and predictions with those ``ahead`` frames later.

    In each frame the nearest pairs of an object and an entry belong together, one by one, as far as
    they are within `NEAR`.
    """
    there = seen = switches = 0
    identity: dict[str, int] = {}
    ahead_errors, stays_errors = [], []
    for frame, found in enumerate(entries):
        present = {name: track[frame] for name, track in objects.items() if frame in track}
        there += len(present)
        for name, entry in _pairs(present, found):
            seen += 1
            switches += identity.get(name, entry.track) != entry.track
            identity[name] = entry.track
            if frame + ahead in objects[name]:
                true = objects[name][frame + ahead]
                ahead_errors.append(_distance(true, entry.predicted))
                stays_errors.append(_distance(true, entry.measured))
    share = seen / there if there else float("nan")
    return ManyScore(share, switches, *_summary(ahead_errors), *_summary(stays_errors))


def _pairs(present: Mapping[str, Places], found: Sequence[Entry]) -> Iterator[tuple[str, Entry]]:
    distances = sorted(
        (_distance(place, entry.measured), name, index)
        for name, place in present.items()
        for index, entry in enumerate(found)
    )
    names: set[str] = set()
    indices: set[int] = set()
    for distance, name, index in distances:
        if distance <= NEAR and name not in names and index not in indices:
            names.add(name)
            indices.add(index)
            yield name, found[index]


def _moves(track: Mapping[int, Places], frame: int) -> bool:
    if frame not in track:
        return False
    near = [track[t] for t in range(frame - AROUND, frame + AROUND + 1) if t in track]
    return bool(np.ptp(near, axis=0).max() >= MOVED)


def _distance(one: Places, other: Places) -> float:
    return float(np.hypot(*(one - other)))


def _summary(errors: Sequence[float]) -> tuple[float, float]:
    if not errors:
        return float("nan"), float("nan")
    return float(np.sqrt(np.mean(np.square(errors)))), float(np.median(errors))
