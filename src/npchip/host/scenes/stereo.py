"""A ball in space, seen by two cameras: two clips and the truth about them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from npchip import bundle
from npchip.base.errors import InputError
from npchip.base.yaml import read_mapping
from npchip.host.scenes.backgrounds import Background, Flat
from npchip.host.scenes.files import (
    DEFAULT_MOTION,
    Settings,
    background_as_data,
    name_of,
    values_of,
)
from npchip.host.scenes.model import Object, Scene
from npchip.host.scenes.motions import Motion, Walls
from npchip.host.scenes.output import DIGITS, check_suffix, write_files
from npchip.host.scenes.render import render
from npchip.host.scenes.rules import Checked, Rule, setting, settings
from npchip.host.scenes.shapes import LARGEST, Shape, disc_crossings
from npchip.host.scenes.space import SPACE_MOTIONS, SpaceMotion
from npchip.host.vision.fusion.camera import Camera, Rig
from npchip.host.vision.fusion.rigfile import rig_as_data
from npchip.machine import PIXELS

SCHEMA: Final = 1
_NEAR: Final = 1e-3
"""Nearest distance, in radii, at which a ball is drawn."""
_TINY: Final = 1e-3
_FAR_AWAY: Final = 2.0**20
_NOWHERE: Final = -_FAR_AWAY


@dataclass(frozen=True, kw_only=True)
class SpaceScene(Checked):
    """A ball that moves in space.

    Attributes:
        motion: motion of its middle.
        radius: radius in metres.
        brightness: brightness of every pixel that lies wholly inside.
        background: background of the ball, the same for both cameras.
        frames: number of frames.
        noise: RMS of the noise of every pixel in every frame, in LSB.
        seed: seed of noise and texture; camera 2 takes the next one.

    Raises:
        InputError: NP283 or NP284, a setting; NP287, a ball that starts in the floor.
    """

    motion: SpaceMotion
    radius: float = setting(Rule("number", 1e-4, 1e4, "radius of the ball in metres"), 0.1)
    brightness: int = setting(Rule("whole", 0, 255, "brightness of the ball"), 220)
    background: Background = field(default_factory=Flat)
    frames: int = setting(Rule("whole", 1, 100_000, "number of frames"), 30)
    noise: float = setting(Rule("number", 0, 32, "noise of every pixel, rms in LSB"), 0.0)
    seed: int = setting(Rule("whole", 0, 2**32 - 2, "seed of noise and texture"), 1)

    def __post_init__(self) -> None:
        """Check the settings; see the class."""
        super().__post_init__()
        self.motion.positions(1, self.radius)

    def positions(self) -> NDArray[np.float64]:
        """Return the middle of the ball in every frame: float64, shape (frames, 3), metres."""
        return self.motion.positions(self.frames, self.radius)


def read_space_scene(path: Path, overrides: Mapping[str, Any] | None = None) -> SpaceScene:
    """Read a scene in space; errors as `npchip.host.scenes.read_scene`.

    Args:
        path: the YAML file (its keys are explained in ``docs/fusion.md``), or the name of a
            bundled scene.
        overrides: options that override the file's settings.
    """
    path = bundle.need("scene", path, "NP280")
    file = Settings(read_mapping(path, "NP280"), str(path), "it")
    motion = file.choice("motion", SPACE_MOTIONS, DEFAULT_MOTION)
    file.name = f"a ball in {file.data.get('motion', DEFAULT_MOTION)} motion"
    file.check_keys((), ("motion", "background", *settings(SpaceScene), *settings(motion)))
    values = {**file.whole(SpaceScene), "motion": file.make(motion, file.read(motion))}
    changes = Settings(overrides or {}, None, "a scene").whole()
    return file.make(SpaceScene, values | changes)


@dataclass(frozen=True)
class _Disc(Shape):
    """A disc with another radius in pixels in every frame."""

    radii: NDArray[np.float64]

    def outline(self, frame: int) -> None:
        """Return None, as a disc has no corners."""

    @property
    def reach(self) -> tuple[float, float]:
        """The largest radius."""
        return float(self.radii.max()), float(self.radii.max())

    def crossings(self, lines: NDArray[np.float64], frame: int) -> list[NDArray[np.float64]]:
        """See `Shape.crossings`."""
        return disc_crossings(lines, float(self.radii[frame]))


@dataclass(frozen=True)
class _Seen(Motion):
    """A motion along known centres."""

    places: NDArray[np.float64]

    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:  # noqa: ARG002
        """Return the centres."""
        return self.places


@dataclass(frozen=True, eq=False)
class View:
    """View of a scene in space by one camera, T frames.

    Attributes:
        clip: uint8, shape (T, rows, cols).
        centers: float64, shape (T, 2): (row, column) of the ball's middle, also outside the frame;
            NaN if it is not in front of the camera.
        radii: float64, shape (T,), pixels; NaN likewise.
        boxes: int64, shape (T, 4): top, left, bottom, right, inclusive, of the pixels in the frame
            that the ball touches; -1 if it touches none.
        visible: bool, shape (T,): whether it touches any.
    """

    clip: NDArray[np.uint8]
    centers: NDArray[np.float64]
    radii: NDArray[np.float64]
    boxes: NDArray[np.int64]
    visible: NDArray[np.bool_]


def render_pair(scene: SpaceScene, rig: Rig) -> tuple[View, View]:
    """Draw the views of both cameras. The same scene gives the same clips.

    A ball becomes a disc of radius·ratio/depth pixels around the projection of its middle
    (decision). The outline of a real ball is an ellipse that is farther from the middle of the
    frame, by (radius/depth)² of its distance from there.

    Args:
        scene: the ball.
        rig: the cameras, whose rows and columns are multiples of 8.

    Raises:
        InputError: NP284 or NP286, a clip cannot have this size of the frames.
    """
    for name, camera in (("camera1", rig.camera1), ("camera2", rig.camera2)):
        if camera.rows % PIXELS or camera.cols % PIXELS:
            raise InputError(
                "NP284",
                f"{name} has {camera.rows} x {camera.cols} pixels: clips have rows and columns in"
                f" multiples of {PIXELS}",
            )
    return _view(scene, rig.camera1, scene.seed), _view(scene, rig.camera2, scene.seed + 1)


def _view(scene: SpaceScene, camera: Camera, seed: int) -> View:
    centers, depth = camera.project(scene.positions())
    ahead = depth > _NEAR * scene.radius
    centers[~ahead] = np.nan
    radii = scene.radius * camera.ratio / np.where(ahead, depth, np.nan)
    drawn = np.where(np.isnan(centers), _NOWHERE, np.clip(centers, -_FAR_AWAY, _FAR_AWAY))
    item = Object(
        shape=_Disc(np.where(ahead, np.clip(radii, _TINY, LARGEST), _TINY)),
        motion=_Seen(drawn),
        brightness=scene.brightness,
    )
    clip, truth = render(
        Scene(
            objects=(item,),
            background=scene.background,
            frames=scene.frames,
            size=(camera.rows, camera.cols),
            noise=scene.noise,
            seed=seed,
        )
    )
    return View(clip, centers, radii, truth.boxes[:, 0], truth.visible[:, 0])


def pair_paths(path: Path) -> tuple[Path, Path]:
    """Return the paths of both clips: ``ball.1.npy`` and ``ball.2.npy`` for ``ball.npy``."""
    one, two = (path.with_name(f"{path.stem}.{n}{path.suffix}") for n in (1, 2))
    return one, two


def write_pair(path: Path, views: tuple[View, View], scene: SpaceScene, rig: Rig) -> None:
    """Write both clips and the truth about them, ``ball.truth.json``, each whole or not at all.

    Args:
        path: path for `pair_paths`.
        views: views from `render_pair`.
        scene: the scene.
        rig: the cameras.

    Raises:
        InputError: NP288, another suffix than ``.npy`` or ``.gif``; NP250, a file cannot be
            written.
    """
    check_suffix(path)
    clips = dict(zip(pair_paths(path), (view.clip for view in views), strict=True))
    write_files(truth_document(views, scene, rig), path, clips)


def truth_document(views: tuple[View, View], scene: SpaceScene, rig: Rig) -> dict[str, Any]:
    """Return the truth as plain data, schema 1 of ``docs/fusion.md``."""
    positions = scene.positions().round(DIGITS).tolist()
    return {
        "schema": SCHEMA,
        "scene": {
            "motion": name_of(scene.motion, SPACE_MOTIONS),
            "background": background_as_data(scene.background),
            **values_of(scene),
            **values_of(scene.motion),
        },
        "rig": rig_as_data(rig),
        "frames": [
            {"index": k, "position": place, "cameras": [_seen(view, k) for view in views]}
            for k, place in enumerate(positions)
        ],
    }


def _seen(view: View, k: int) -> dict[str, Any]:
    ahead, visible = not np.isnan(view.radii[k]), bool(view.visible[k])
    return {
        "center": view.centers[k].round(DIGITS).tolist() if ahead else None,
        "radius": round(float(view.radii[k]), DIGITS) if ahead else None,
        "box": view.boxes[k].tolist() if visible else None,
        "visible": visible,
    }
