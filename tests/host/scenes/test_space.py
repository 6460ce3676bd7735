"""A ball in space before two cameras: mechanics, drawing, truth, and the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import open_frames
from npchip.host.scenes import Flat, Gradient
from npchip.host.scenes.space import Accelerated, Jumping, Orbiting, SpaceMotion, Straight
from npchip.host.scenes.stereo import SpaceScene, pair_paths, read_space_scene, render_pair
from npchip.host.vision.fusion import Camera, Rig, load_rig, locate
from npchip.host.vision.fusion.experiment import rms
from tests.support.commands import invoke
from tests.support.rigs import CHIPS, RIGS

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
EXAMPLES = sorted(SCENES.glob("space-*.yaml"))


# ---- motions


def test_straight_and_accelerated_motion_follow_their_formulas() -> None:
    line = Straight(start=(1, 2, 3), velocity=(0.1, -0.2, 0.3)).positions(50, 1.0)
    np.testing.assert_allclose(line[7], [1.7, 0.6, 5.1])
    falling = Accelerated(start=(1, 2, 3), velocity=(0.1, 0, 1), acceleration=(0, 0.5, -0.2))
    np.testing.assert_allclose(falling.positions(9, 1.0)[6], [1.6, 2 + 9, 3 + 6 - 3.6])


def test_a_circle_keeps_its_distance_and_its_plane() -> None:
    circle = Orbiting(center=(1, 2, 3), orbit=0.7, period=24, phase=30, tilt=40)
    path = circle.positions(60, 1.0) - [1, 2, 3]
    np.testing.assert_allclose(np.linalg.norm(path, axis=1), 0.7)
    normal = np.array([0, -np.sin(np.radians(40)), np.cos(np.radians(40))])
    np.testing.assert_allclose(path @ normal, 0, atol=1e-12)
    np.testing.assert_allclose(path[0][0], 0.7 * np.cos(np.radians(30)))
    np.testing.assert_allclose(path[24], path[0])
    angle = np.degrees(np.arccos(path[1] @ path[0] / 0.49))
    assert angle == pytest.approx(360 / 24)
    rising = Orbiting(center=(1, 2, 3), orbit=0.7, period=-24, rise=0.1).positions(25, 1.0)
    assert rising[24] == pytest.approx([1.7, 2, 5.4])
    assert rising[6] == pytest.approx([1, 1.3, 3.6])


def test_a_bounce_is_what_the_equations_of_motion_give() -> None:
    """The same drop, integrated by SciPy from impact to impact."""
    ball = Jumping(
        start=(0, 0, 1.0), velocity=(0.1, 0.2, 0.05), gravity=0.02, restitution=0.7, floor=-0.5
    )
    path = ball.positions(60, 0.2)
    np.testing.assert_allclose(path[:, :2], np.outer(np.arange(60), [0.1, 0.2]))

    def ground(_t: float, state: Any) -> Any:
        return state[0] + 0.3

    ground.terminal, ground.direction = True, -1  # type: ignore[attr-defined]
    state, now, heights = [1.0, 0.05], 0.0, {}
    while now < 59:
        run = scipy.integrate.solve_ivp(
            lambda _t, s: [s[1], -0.02],
            (now, 59),
            state,
            events=ground,
            dense_output=True,
            rtol=1e-10,
            atol=1e-12,
        )
        solution: Any = run.sol
        for k in range(60):
            if now <= k <= run.t[-1]:
                heights[k] = float(solution(k)[0])
        now, state = run.t[-1], [-0.3, -0.7 * run.y[1, -1]]
    np.testing.assert_allclose(path[:, 2], [heights[k] for k in range(60)], atol=1e-6)
    assert path[:, 2].min() >= -0.3


def test_a_ball_does_not_start_in_the_floor() -> None:
    with pytest.raises(InputError, match=r"radius 0.1 above a floor at 0 starts at z = 0.1") as e:
        SpaceScene(motion=Jumping(start=(0, 0, 0.05), gravity=1))
    assert e.value.code == "NP287"
    with pytest.raises(InputError, match="NP284"):
        Orbiting(center=(0, 0, 0), orbit=1, period=0)


# ---- drawing


def weighted_centroid(frame: NDArray[np.uint8], background: int) -> NDArray[np.float64]:
    light = frame.astype(float) - background
    rows, cols = np.mgrid[: frame.shape[0], : frame.shape[1]]
    return np.array([(light * rows).sum() / light.sum(), (light * cols).sum() / light.sum()])


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_what_is_drawn_is_where_the_ball_is(path: Path) -> None:
    """Centroid and area of the picture against projection, and back to space by both cameras."""
    scene = read_space_scene(path)
    views = render_pair(scene, CHIPS)
    truth = scene.positions()
    centroids = []
    for view, camera in zip(views, (CHIPS.camera1, CHIPS.camera2), strict=True):
        pixels, depth = camera.project(truth)
        np.testing.assert_allclose(view.centers, pixels)
        assert view.visible.all()
        assert view.clip.shape == (scene.frames, 64, 80)
        found = np.array([weighted_centroid(frame, 20) for frame in view.clip])
        inside = np.asarray(((view.boxes[:, :2] > 0) & (view.boxes[:, 2:] < [63, 79])).all(axis=1))
        np.testing.assert_allclose(found[inside], pixels[inside], atol=0.03)
        light = (view.clip.astype(float) - 20).sum(axis=(1, 2)) / 200
        area = np.pi * (scene.radius * camera.ratio / depth) ** 2
        np.testing.assert_allclose(light[inside], area[inside], rtol=0.02)
        centroids.append(np.where(inside[:, None], found, np.nan))
    back = locate(CHIPS, centroids[0], centroids[1], "reprojection")
    assert back.valid.mean() > 0.9
    assert rms(back.points, truth) < 0.002


def test_cameras_that_see_nothing_draw_nothing() -> None:
    """Behind one camera, beside the other, and through its pinhole."""
    scene = SpaceScene(
        motion=Straight(start=(2.3, -0.5, 0), velocity=(0, 0.25, 0)), radius=0.05, frames=12
    )
    one, two = render_pair(scene, CHIPS)
    np.testing.assert_array_equal(one.visible, [False] * 3 + [True] * 9)  # frame 2 is the pinhole
    assert np.isnan(one.centers[:3]).all()
    assert (one.clip[:3] == 20).all()
    assert (one.boxes[0] == -1).all()
    assert not two.visible[:5].any()
    assert np.isfinite(two.centers).all()
    near = render_pair(SpaceScene(motion=Straight(start=(2.3, 0.02, 0)), radius=9), CHIPS)[0]
    assert (near.clip == 220).all()


def test_settings_of_the_whole_scene() -> None:
    still = Straight(start=(2.3, 2.3, 0))
    plain = SpaceScene(motion=still, frames=3)
    loud = SpaceScene(
        motion=still, frames=3, noise=3, seed=5, background=Gradient(first=0, last=90)
    )
    one, two = render_pair(plain, CHIPS)
    assert (one.clip == one.clip[0]).all()
    assert plain.background == Flat()
    noisy, other = render_pair(loud, CHIPS)
    assert (noisy.clip != noisy.clip[0]).any()
    difference = noisy.clip[1].astype(int) - other.clip[1]
    assert difference[:8, :8].std() > 2  # the cameras' noise is independent
    assert (render_pair(loud, CHIPS)[0].clip == noisy.clip).all()
    assert (two.clip[0].max(), two.clip[0].min()) == (220, 20)


def test_cameras_of_any_size_in_eights() -> None:
    rig = load_rig(RIGS / "thesis.yaml")
    ball = SpaceScene(motion=Straight(start=(4, 4, 0)))
    assert render_pair(ball, rig)[0].clip.shape[1:] == (160, 160)
    odd = Rig(camera1=Camera(position=(1, 0, 0), looks="+y", ratio=9, rows=12, cols=16),
              camera2=CHIPS.camera2, cell=4)  # fmt: skip
    with pytest.raises(InputError, match=r"camera1 has 12 x 16 pixels.*multiples of 8"):
        render_pair(ball, odd)


# ---- the command


def test_the_command_writes_two_clips_and_the_truth(tmp_path: Path) -> None:
    rig = RIGS / "chip.yaml"
    for name in ("ball.npy", "ball.gif"):
        done = invoke("scene", EXAMPLES[0], "--rig", rig, "--frames", "9", "-o", tmp_path / name)
        assert done.exit_code == 0, done.output
    assert "ball.1.gif: 9 frames of 64 x 80 pixels, the ball is visible in 9" in done.output
    assert "ball.truth.json: where it is, from (1.40, 2.20, -0.30) to (1.76," in done.output
    scene = read_space_scene(EXAMPLES[0], {"frames": 9})
    views = render_pair(scene, CHIPS)
    for suffix in ("npy", "gif"):
        for path, view in zip(pair_paths(tmp_path / f"ball.{suffix}"), views, strict=True):
            assert (np.stack(list(open_frames(str(path), 64, 80))) == view.clip).all()
    form = json.loads((tmp_path / "ball.truth.json").read_text())
    assert form["schema"] == 1
    np.testing.assert_allclose(
        [f["position"] for f in form["frames"]], scene.positions(), atol=1e-6
    )
    for k, frame in enumerate(form["frames"]):
        assert frame["index"] == k
        for camera, view in zip(frame["cameras"], views, strict=True):
            np.testing.assert_allclose(camera["center"], view.centers[k], atol=1e-6)
            assert camera["radius"] == pytest.approx(view.radii[k], abs=1e-6)
            assert camera["box"] == view.boxes[k].tolist()
            assert camera["visible"]
    for name, part in (("scene.yaml", form["scene"]), ("rig.yaml", form["rig"])):
        (tmp_path / name).write_text(json.dumps(part))
    assert read_space_scene(tmp_path / "scene.yaml") == scene
    assert load_rig(tmp_path / "rig.yaml") == CHIPS


def test_what_is_not_seen_is_null_in_the_truth(tmp_path: Path) -> None:
    file = tmp_path / "s.yaml"
    file.write_text("start: [2.3, -1, 0]\nframes: 1\n")
    done = invoke("scene", file, "--rig", RIGS / "chip.yaml", "-o", tmp_path / "c.npy")
    assert "visible in 0" in done.output
    frame = json.loads((tmp_path / "c.truth.json").read_text())["frames"][0]
    nothing = {"center": None, "radius": None, "box": None, "visible": False}
    assert frame["cameras"][0] == nothing
    assert frame["cameras"][1]["center"] is not None
    assert frame["cameras"][1]["box"] is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- 3", "NP280"),
        (
            "start: [1, 2, 3]\nradios: 2",
            "s.yaml:2: error: a ball in linear motion has no radios",
        ),
        ("radius: 1", "s.yaml:1: error: a ball in linear motion needs start"),
        ("start: [1, 2]", "s.yaml:1: error: start: expected [x, y, z], each from -10000 to 10000"),
        (
            "start: [1, 2, 3]\nmotion: flying",
            "s.yaml:2: error: motion: expected linear, accelerating",
        ),
        ("start: [1, 2, 3]\nradius: 0", "s.yaml:2: error: radius: expected a number from 0.0001"),
        (
            "start: [0, 0, 0]\nmotion: bouncing\ngravity: 1",
            "s.yaml:1: error: bouncing: a ball of radius",
        ),
        ("start: [1, 2, 3]\nshape: disc", "NP281"),
        ("start: [1, 2, 3]\nbackground: {kind: grey}", "NP285"),
    ],
)
def test_files_that_make_no_sense(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "s.yaml"
    file.write_text(text)
    done = invoke("scene", file, "--rig", RIGS / "chip.yaml", "-o", tmp_path / "c.npy")
    assert done.exit_code == 2
    assert message in done.output
    assert not list(tmp_path.glob("c.*"))


def test_options_that_exclude_each_other(tmp_path: Path) -> None:
    rig, out = ("--rig", RIGS / "chip.yaml"), ("-o", tmp_path / "c.npy")
    for arguments, named in (
        (("--shape", "disc", *rig), "not from --shape"),
        ((EXAMPLES[0], *rig, "--machine", "default"), "not from --machine"),
        ((EXAMPLES[0], *rig, "--radius", "3"), "not from --radius"),
        (rig, "NP289"),
    ):
        done = invoke("scene", *arguments, *out)
        assert done.exit_code == 2
        assert named in done.output
    done = invoke("scene", EXAMPLES[0], "--rig", tmp_path / "none.yaml", *out)
    assert done.exit_code == 2
    assert "NP500" in done.output


def test_every_motion_has_an_example() -> None:
    motions: set[type[SpaceMotion]] = {type(read_space_scene(path).motion) for path in EXAMPLES}
    assert motions == {Straight, Accelerated, Orbiting, Jumping}
