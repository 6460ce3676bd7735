"""npchip.host.vision.orientation: scene, pictures, vertices, against independent calculations."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.base.errors import InputError
from npchip.host.scenes.shapes import FULL, Polygon
from npchip.host.scenes.shapes import coverage as scene_coverage
from npchip.host.vision.orientation.corners import corner_pixels, vertices
from npchip.host.vision.orientation.pictures import BACKGROUND, HIGHLIGHT, OBJECT, coverage, render
from npchip.host.vision.orientation.scene import (
    CAMERAS,
    CENTROID,
    CHIP,
    HIGHEST,
    LOWEST,
    THESIS,
    TRIANGLE,
    Camera,
    bhaskara_sine,
    cartesian,
    cartesian_bhaskara,
    fits,
    height_from_scale,
    polar_and_azimuth,
    position_of,
    project,
    random_positions,
    spherical,
    yaw_and_pitch,
)

places = st.tuples(*(st.floats(low, high) for low, high in zip(LOWEST, HIGHEST, strict=True)))


# ---- scene


def test_the_triangle_has_sides_of_5_12_13_and_its_centroid_at_the_origin() -> None:
    sides = sorted(np.linalg.norm(np.roll(TRIANGLE, 1, axis=0) - TRIANGLE, axis=1))
    assert sides == pytest.approx([250, 600, 650])
    assert TRIANGLE.mean(axis=0) == pytest.approx([0, 0, 0])


def by_rotations(position: tuple[float, ...], camera: Camera) -> list[list[float]]:
    """Project with plain rotations by yaw and pitch, one after the other."""
    yaw, pitch = (radians(angle) for angle in yaw_and_pitch(np.array([position]))[0])
    found = []
    for vertex in TRIANGLE + CENTROID:
        x, y, z = (float(a - b) for a, b in zip(vertex, position, strict=True))
        ahead, left = x * cos(yaw) + y * sin(yaw), -x * sin(yaw) + y * cos(yaw)
        depth, up = ahead * cos(pitch) + z * sin(pitch), -ahead * sin(pitch) + z * cos(pitch)
        found.append(
            [
                (camera.rows - 1) / 2 - camera.focal * up / depth,
                (camera.cols - 1) / 2 - camera.focal * left / depth,
            ]
        )
    return found


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
@given(position=places)
def test_projection(position: tuple[float, float, float], camera: Camera) -> None:
    found = project(np.array([position]), camera=camera)[0]
    if np.isfinite(found).all():
        expected = by_rotations(position, camera)
        assert found.tolist() == [pytest.approx(p, abs=1e-6, rel=1e-6) for p in expected]


@given(position=places)
def test_angles_and_coordinates_can_be_undone(position: tuple[float, float, float]) -> None:
    positions = np.array([position])
    assert cartesian(spherical(positions)) == pytest.approx(positions, abs=1e-6)
    yaw, pitch = yaw_and_pitch(positions)[0]
    assert 0 <= yaw < 360
    assert -90 <= pitch < 0
    radial = spherical(positions)[0, 0]
    assert position_of(yaw, pitch, radial) == pytest.approx(position, abs=1e-6)
    turned = polar_and_azimuth(np.array([[yaw, pitch]]))
    assert np.cos(turned - spherical(positions)[:, 1:]) == pytest.approx(np.ones((1, 2)))


def test_a_camera_right_above_the_centroid() -> None:
    above = np.array([[500.0, 500, 1000]])
    assert spherical(above)[0, :2].tolist() == [1000, 0]
    side = np.linalg.norm(np.diff(project(above)[0], axis=0), axis=1)[0]  # the leg of 250 mm
    assert side == pytest.approx(25)
    assert height_from_scale(np.array([side]), length=250) == pytest.approx([1000])


def test_height_by_scale_alone() -> None:
    """3.4.1: a bottom-view camera needs nothing else."""
    heights = np.linspace(800, 3000, 12)
    above = np.column_stack([np.full((12, 2), 500.0), heights])
    seen = project(above)
    long_leg = np.linalg.norm(seen[:, 2] - seen[:, 0], axis=1)
    assert height_from_scale(long_leg) == pytest.approx(heights)


def test_nothing_is_seen_behind_the_camera() -> None:
    low = np.array([[500.0, 560, 20]])  # nearly in the plane, above the long leg
    assert np.isnan(project(low)).any()
    assert not fits(low).any()
    with pytest.raises(ValueError, match="behind the camera"):
        render(low)


@given(angle=st.floats(-20, 20))
def test_bhaskara(angle: float) -> None:
    assert bhaskara_sine(np.array([angle]))[0] == pytest.approx(sin(angle), abs=0.00164)


def test_bhaskara_is_exact_where_he_has_it() -> None:
    exact = np.array([0, pi / 6, pi / 2, 5 * pi / 6, pi, 7 * pi / 6, 3 * pi / 2])
    assert bhaskara_sine(exact) == pytest.approx(np.sin(exact), abs=1e-12)


def test_bhaskara_costs_little() -> None:
    """1.8 mm rms along an axis, on positions whose distance is known."""
    positions = random_positions(2_000, 3)
    error = cartesian_bhaskara(spherical(positions)) - positions
    assert 1.2 < np.sqrt((error**2).mean()) < 2.2


@pytest.mark.parametrize("camera", CAMERAS.values(), ids=CAMERAS)
def test_positions(camera: Camera) -> None:
    positions = random_positions(3_000, 5, camera)
    assert (positions >= LOWEST).all()
    assert (positions <= HIGHEST).all()
    assert fits(positions, camera).all()
    assert np.array_equal(random_positions(50, 5, camera), positions[:50])
    assert not np.array_equal(random_positions(50, 6, camera), positions[:50])
    rng = np.random.default_rng(2)
    assert 0.94 < fits(rng.uniform(LOWEST, HIGHEST, (4_000, 3)), camera).mean() < 0.98


# ---- pictures


@pytest.mark.parametrize("seed", range(12))
def test_coverage_is_that_of_the_scenes(seed: int) -> None:
    """The scenes measure each row on 64 lines, the pictures on 16."""
    rng = np.random.default_rng(seed)
    corners = rng.uniform(2, 30, (3, 2))
    shape = Polygon(vertices=tuple((float(r), float(c)) for r, c in corners))
    middle = corners.mean(axis=0)
    rows, cols, part = scene_coverage(shape, (middle[0], middle[1]), 0, (32, 40))
    expected = np.zeros((32, 40))
    expected[rows, cols] = part / FULL
    found = coverage(corners[np.newaxis], 32, 40)[0]
    assert abs(found - expected).max() < 0.05
    assert abs(found - expected).mean() < 0.002


def test_coverage_is_cut_off_at_the_frame() -> None:
    square = np.array([[[-5.0, -5], [-5, 4], [1.75, 4], [1.75, -5]]])
    found = coverage(square, 8, 8)[0]
    assert found[:2, :4] == pytest.approx(np.ones((2, 4)))
    assert found[0, 4] == 0.5
    assert found[2, 0] == 0.25
    assert found.sum() == pytest.approx(2.25 * 4.5)


def test_pictures() -> None:
    positions = random_positions(300, 4)
    pictures = render(positions)
    assert pictures.shape == (300, 100, 100)
    assert pictures.min() == BACKGROUND
    assert np.array_equal(render(positions), pictures)
    assert np.array_equal(render(positions[257:260]), pictures[257:260])
    near = spherical(positions)[:, 0] < 1500
    assert (pictures[near].max(axis=(1, 2)) == HIGHLIGHT).mean() > 0.9
    plain = render(positions, highlight=False)
    assert plain.max() == OBJECT
    assert (plain <= pictures).all()


# ---- vertices


@pytest.mark.parametrize(
    ("camera", "within"), [(THESIS, 0.97), (CHIP, 0.97)], ids=["100x100", "64x80"]
)
def test_vertices_are_found_in_order(camera: Camera, within: float) -> None:
    """Measured on 8,000: within 3 pixels .992 and .988; none is mistaken for another."""
    positions = random_positions(250, 9, camera)
    found = np.array([vertices(picture) for picture in render(positions, camera)])
    error = np.linalg.norm(found - project(positions, camera=camera), axis=2).max(axis=1)
    assert (error < 3).mean() > within
    assert error.max() < 9


def test_whole_numbers_are_the_middles_of_pixels() -> None:
    """Fails before: vertices and projections counted from a corner of the frame."""
    picture = render(np.array([[900.0, 250, 1400]]))[0]
    pixels = corner_pixels(picture)
    assert pixels is not None
    assert np.array_equal(vertices(picture), pixels)
    below = project(np.array([[500.0, 500, 1000]]), np.zeros((1, 3)))[0, 0]
    assert below.tolist() == [49.5, 49.5]  # between the two middle rows and columns of 100
    one_pixel = np.array([[[2.5, 4.5], [2.5, 5.5], [3.5, 5.5], [3.5, 4.5]]])
    assert np.argwhere(coverage(one_pixel, 8, 8)[0]).tolist() == [[3, 5]]


def test_corner_pixels_of_noise_are_pixels_of_it() -> None:
    rng = np.random.default_rng(3)
    picture = np.where(rng.random((64, 80)) < 0.01, 200, 0).astype(np.uint8)
    found = corner_pixels(picture)
    assert found is not None
    assert (picture[tuple(found.T)] == 200).all()


def drawn(mask: np.ndarray, bright: tuple[int, int] | None = None) -> np.ndarray:
    picture = np.where(mask, OBJECT, BACKGROUND).astype(np.uint8)
    if bright:
        picture[bright] = HIGHLIGHT
    return picture


ROWS, COLS = np.ogrid[:100, :100]
GOOD = render(np.array([position_of(45, -60, 1500)]))[0]


@pytest.mark.parametrize(
    ("picture", "code", "text"),
    [
        (np.full((100, 100), 20, np.uint8), "NP450", "the brightest is 20"),
        (drawn((ROWS - 50) ** 2 + (COLS - 50) ** 2 < 200, (50, 50)), "NP451", "beyond"),
        (drawn((abs(ROWS - 50) < 9) & (abs(COLS - 50) < 9), (50, 50)), "NP451", "beyond"),
        (drawn(ROWS > COLS, (60, 5)), "NP451", "border"),
        (drawn((ROWS == 40) & (COLS > 20) & (COLS < 60), (40, 21)), "NP451", "on a line"),
        (np.where((ROWS - 50) ** 2 > 900, 20, 200).astype(np.uint8), "NP451", "border"),
        (drawn(GOOD > 100), "NP452", "highlighted"),
        (np.maximum(GOOD, np.roll(GOOD, 30, axis=0)), "NP451", "no triangle"),
        (np.random.default_rng(1).integers(0, 256, (100, 100), np.uint8), "NP451", "border"),
    ],
)
def test_pictures_without_the_triangle(picture: np.ndarray, code: str, text: str) -> None:
    with pytest.raises(InputError, match=text) as caught:
        vertices(picture, name="shot.png")
    assert caught.value.code == code
    assert "shot.png" in caught.value.message


def test_a_triangle_with_a_hole_is_none() -> None:
    picture = GOOD.copy()
    rows, cols = np.nonzero(picture == OBJECT)
    row, col = int(rows.mean()), int(cols.mean())
    picture[row - 4 : row + 5, col - 4 : col + 5] = BACKGROUND
    with pytest.raises(InputError, match=r"dark|beyond"):
        vertices(picture)
