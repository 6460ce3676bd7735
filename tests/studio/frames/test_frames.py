"""The page's frames in Node: arrays, fitting, order, and the formats that it reads itself."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from npchip.frames.order import in_order
from tests.studio.frames import files
from tests.studio.frames.asking import Frames, array_of, engine, expected, found, same
from tests.support.page_code import Bundles

pytestmark = pytest.mark.long

TYPES = ("u1", "i1", "<u2", ">u2", "<i4", ">i4", "<i8", ">u8")
NOT_NUMBERS = ("?", "<f4", "<f8", "<c8", "<U3", "S2", "<M8[s]")


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory, bundles: Bundles) -> Iterator[Frames]:
    """The page's frames in Node."""
    with engine("node", tmp_path_factory.mktemp("node"), bundles) as frames:
        yield frames


def agree(frames: Frames, path: Path, **options: Any) -> None:
    """Assert that the page takes a file as npchip does."""
    answer, wanted = frames.open(path, **options), expected(path, **options)
    assert same(found(answer), wanted), (path.name, wanted, answer.get("text"))


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder for files."""
    return tmp_path_factory.mktemp("files")


@given(st.data())
def test_arrays_of_any_type_and_order(node: Frames, place: Path, data: st.DataObject) -> None:
    shape = data.draw(st.sampled_from([(3, 64, 80), (64, 80), (1, 70, 90), (2, 3, 5), (0, 64, 80)]))
    kind = data.draw(st.sampled_from(TYPES))
    top = data.draw(st.sampled_from([255, 255, 255, 127, 256, 40_000]))
    top = min(top, np.iinfo(kind).max)
    seed = data.draw(st.integers(0, 1 << 30))
    array = np.random.default_rng(seed).integers(0, top, shape, endpoint=True).astype(kind)
    if array.size and kind[-2] == "i" and data.draw(st.booleans()):
        array.flat[-1] = -1
    if data.draw(st.booleans()):
        array = np.asfortranarray(array)
    path = place / "array.npy"
    with path.open("wb") as file:
        version = data.draw(st.sampled_from([(1, 0), (2, 0), (3, 0)]))
        np.lib.format.write_array(file, array, version)
    agree(node, path, fit=data.draw(st.sampled_from([None, "crop", "resize"])))


@pytest.mark.parametrize("kind", NOT_NUMBERS)
def test_arrays_of_other_types(node: Frames, tmp_path: Path, kind: str) -> None:
    path = tmp_path / "array.npy"
    np.save(path, np.zeros((2, 64, 80), kind))
    agree(node, path)


@pytest.mark.parametrize(
    "shape",
    [
        (),
        (5120,),
        (2, 3, 64, 80),
        (64, 80, 3),
        (2, 64, 80, 4),
        (2, 1, 64, 80),
        (80, 64),
        (2, 0, 80),
    ],
)
def test_arrays_of_other_shapes(node: Frames, tmp_path: Path, shape: tuple[int, ...]) -> None:
    path = tmp_path / "array.npy"
    np.save(path, np.zeros(shape, np.uint8))
    agree(node, path)


def test_objects_are_never_unpickled(node: Frames, tmp_path: Path) -> None:
    path = tmp_path / "array.npy"
    np.save(path, np.array([{}], object))
    agree(node, path)


HEADERS = [
    "{'descr': '|u1', 'fortran_order': False, 'shape': (64, 80), }",
    '{"descr": "|u1", "fortran_order": False, "shape": (64, 80)}',
    "{'shape': (64L, 80L), 'descr': '|u1', 'fortran_order': False}",
    "{'descr': '|u1', 'fortran_order': 0, 'shape': (64, 80), }",
    "{'descr': '|u1', 'fortran_order': False, 'shape': (64, -80), }",
    "{'descr': '|u1', 'fortran_order': False, 'shape': (64), }",
    "{'descr': '|u1', 'fortran_order': False}",
    "{'descr': '|u1', 'fortran_order': False, 'shape': (64, 80), 'more': 1}",
    "{'descr': '|u3', 'fortran_order': False, 'shape': (64, 80), }",
    "{'descr': [('x', '|u1')], 'fortran_order': False, 'shape': (64, 80), }",
    "{'descr': [('x', '|O')], 'fortran_order': False, 'shape': (64, 80), }",
    "{'descr': '|u1', 'fortran_order': False, 'shape': (9999999999, 64, 80), }",
    "__import__('os')",
    "",
]


@pytest.mark.parametrize("header", HEADERS)
@pytest.mark.parametrize("behind", [5120, 5119, 5121])
def test_headers_that_others_write(node: Frames, tmp_path: Path, header: str, behind: int) -> None:
    if "[" in header and behind != 5120:
        return  # refused for its type, whatever it takes
    path = tmp_path / "array.npy"
    length = len(header).to_bytes(2, "little")
    path.write_bytes(b"\x93NUMPY\1\0" + length + header.encode() + bytes(behind))
    agree(node, path)


SIZES = st.tuples(st.integers(1, 90), st.integers(1, 90))


@given(
    st.tuples(SIZES, SIZES),
    st.sampled_from([None, "crop", "resize"]),
    st.integers(0, 1 << 30),
)
def test_fitting_is_exact(
    node: Frames,
    place: Path,
    sizes: tuple[tuple[int, int], tuple[int, int]],
    fit: Any,
    seed: int,
) -> None:
    source, size = sizes
    path = place / "fitted.npy"
    rng = np.random.default_rng(seed)
    np.save(path, rng.integers(0, 256, (2, *source), np.uint8))
    if source[1] <= 4:
        return  # an array like colours
    agree(node, path, size=size, fit=fit)


def test_another_size_asks_how_to_fit(node: Frames, tmp_path: Path) -> None:
    path = tmp_path / "array.npy"
    for shape, croppable in (((2, 100, 100), True), ((2, 100, 70), False)):
        np.save(path, np.zeros(shape, np.uint8))
        answer = node.open(path)
        assert answer["error"] == "NP217"
        assert answer["croppable"] is croppable
        assert f"{shape[1]} x {shape[2]}" in answer["text"]
        assert ("Crop" in answer["help"]) is croppable


def test_luma_is_that_of_pillow(node: Frames) -> None:
    rng = np.random.default_rng(5)
    colours = rng.integers(0, 256, (20_000, 3), np.uint8)
    wanted = np.asarray(Image.fromarray(colours[None]).convert("L")).ravel()
    assert node.ask("luma", colours=colours.tolist()) == wanted.tolist()


PARTS = st.sampled_from(
    [
        "img",
        "IMG",
        "_",
        "-",
        "t",
        ".",
        "1",
        "2",
        "10",
        "010",
        "0.5",
        "0.25",
        "1.10",
        "é",
        "ß",
        " ",
        "=-3",
    ]
)


@given(st.lists(st.lists(PARTS, min_size=1, max_size=5).map("".join), unique=True, max_size=12))
def test_natural_order(node: Frames, names: list[str]) -> None:
    paths = [f"{name}.png" for name in names]
    wanted = [str(path) for path in in_order([Path(path) for path in paths])]
    assert node.ask("order", names=paths) == wanted


@pytest.mark.parametrize("seed", range(3))
def test_png_of_every_kind(node: Frames, tmp_path: Path, seed: int) -> None:
    for path in files.write(tmp_path, files.pngs(np.random.default_rng(seed))):
        agree(node, path)


def browser_decodes(path: Path) -> bool:
    """Tell a format that only browsers decode."""
    return path.suffix in (".bmp", ".gif", ".jpg", ".webp")


def test_images_that_the_page_reads_itself(node: Frames, tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    made = [*files.pictures(rng), *files.animations(rng)]
    for path in files.write(tmp_path, iter(made)):
        if not browser_decodes(path):
            agree(node, path)


PORTABLE = [
    b"P2 # a remark\n80 64 15\n" + b" ".join(b"%d" % (n % 16) for n in range(5120)),
    b"P1 80 64\n" + b"01101" * 1024,
    b"P3 80 64 100\n" + b" ".join(b"%d" % (n % 101) for n in range(15360)),
    b"P5 80 64 100\n" + bytes(n % 120 for n in range(5120)),
    b"P5\n80 64\n255\n" + bytes(5119),
    b"P5\n80 64\n65535\n" + bytes(10240),
    b"P2 80 64 15\n" + b"16 " * 5120,
    b"P2 80 64 15\n" + b"1 " * 5119,
    b"P2 80 64 15\n" + b"x " * 5120,
    b"P5 80 64 255 " + bytes(5120) + b"P6 80 64 255 " + bytes(range(256)) * 60 + b" \n",
    b"P4 81 64 " + bytes(range(256)) * 3,
    b"P5 80 0 255 ",
    b"P5 80",
    b"P9 80 64 255 " + bytes(5120),
]


@pytest.mark.parametrize("data", PORTABLE, ids=range(len(PORTABLE)))
def test_portable_pictures(node: Frames, tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "picture.pgm"
    path.write_bytes(data)
    agree(node, path, fit="resize")


def test_several_images_are_frames_in_natural_order(node: Frames, tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    folder = tmp_path / "shots"
    folder.mkdir()
    for index in (10, 9, 1, 100):
        Image.fromarray(files.scene(rng)).save(folder / f"shot_{index}.png")
    (folder / "notes.txt").write_text("no image")
    (folder / ".hidden.png").write_text("no image")
    answer = node.open(*folder.iterdir())
    assert same(found(answer), expected(folder))
    files.write(folder, iter([("two.png", dict(files.animations(rng))["00.png"])]))
    assert found(node.open(*folder.iterdir())) == "NP223"


def test_files_that_hold_no_frames(node: Frames, tmp_path: Path) -> None:
    for name, data in (
        ("a.txt", b"text"),
        ("plain", b"text"),
        ("a.npz", b"PK\3\4"),
        ("a.png", b""),
        ("a.png", b"II*\0 and more"),
        ("a.npy", b"\x89PNG\r\n\x1a\n"),
    ):
        path = tmp_path / name
        path.write_bytes(data)
        answer = node.open(path)
        assert answer["error"] in ("NP212", "NP214"), answer
        assert name in answer["text"]
        assert answer["help"] or not data


def test_a_scene_file_is_refused_with_what_draws_it(node: Frames, tmp_path: Path) -> None:
    path = tmp_path / "ball.yaml"
    path.write_text("objects: []\n")
    answer = node.open(path)
    assert answer["error"] == "NP212"
    assert "npchip scene ball.yaml -o ball.npy" in answer["help"]


def test_damaged_images_get_a_message(node: Frames, tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    made = [*files.pngs(rng), *files.pictures(rng), *files.animations(rng)]
    for name, data in made:
        path = tmp_path / (name if "." in name else f"{name}.png")
        if browser_decodes(path):
            continue
        for _ in range(2):
            broken = bytearray(data[: int(rng.integers(len(data)))])
            path.write_bytes(broken)
            assert isinstance(found(node.open(path)), str), path.name
            changed = bytearray(data)
            changed[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
            path.write_bytes(changed)
            answer = node.open(path)
            assert "frames" in answer or answer["error"].startswith("NP"), (path.name, answer)


def test_opening_can_be_stopped(node: Frames, tmp_path: Path) -> None:
    rng = np.random.default_rng(6)
    [path] = files.write(tmp_path, iter([("a.png", dict(files.animations(rng))["00.png"])]))
    file = {"name": path.name, "data": base64.b64encode(path.read_bytes()).decode()}
    answer = node.ask("open", files=[file], size=[64, 80], stopAfter=1)
    assert answer["error"] == "AbortError"


def test_a_clip_is_saved_as_numpy_reads_it(node: Frames, tmp_path: Path) -> None:
    array = np.random.default_rng(3).integers(0, 256, (7, 64, 80), np.uint8)
    path = tmp_path / "clip.npy"
    np.save(path, array)
    file = {"name": path.name, "data": base64.b64encode(path.read_bytes()).decode()}
    saved = base64.b64decode(node.ask("save", files=[file], size=[64, 80])["data"])
    assert saved == path.read_bytes()


def drawn(node: Frames, **changes: Any) -> NDArray[np.uint8]:
    drawing = {"rows": 64, "cols": 80, "background": 10, "frames": 5}
    drawing |= {"strokes": [], "motion": {"rows": 0, "cols": 0}} | changes
    return array_of(node.ask("drawn", drawing=drawing))


def test_a_drawn_scene_moves(node: Frames) -> None:
    points = [{"row": 30, "col": 20}, {"row": 30, "col": 25}]
    strokes = [{"points": points, "brush": 1, "grey": 200}]
    frames = drawn(node, strokes=strokes, motion={"rows": -0.5, "cols": 2})
    for index, row in enumerate([30, 30, 29, 29, 28]):
        wanted = np.full((64, 80), 10, np.uint8)
        wanted[row, 20 + 2 * index : 26 + 2 * index] = 200
        assert np.array_equal(frames[index], wanted), index


def test_a_drawn_scene_can_be_rubbed_out_and_leaves_the_picture(node: Frames) -> None:
    disc = {"points": [{"row": 30, "col": 40}], "brush": 9, "grey": 255}
    hole = {"points": [{"row": 30, "col": 40}], "brush": 3, "grey": None}
    frames = drawn(node, strokes=[disc, hole], motion={"rows": 0, "cols": 30})
    assert frames[0, 30, 44] == 255
    assert frames[0, 30, 40] == 10
    assert frames[0, 25:36, 35:46].max() == 255
    assert (frames[0] == 255).sum() == (frames[1] == 255).sum()
    assert (frames[2] == 10).all()
