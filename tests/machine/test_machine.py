"""Machine files: the shipped ones, a user's own, and every mistake in one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip.base.errors import InputError
from npchip.machine import BUILTIN, Cost, Link, Machine, Sensor, load_machine

CLASSES = frozenset(
    {"move", "alu", "memory", "neighbour", "mask", "branch", "global_or"}
    | {"sample", "output", "input", "control"}
)
BIG = "extends: default\ngeometry: {np_rows: 16, np_cols: 20}\n"


def write(folder: Path, text: str, name: str = "mine.yaml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def failure(folder: Path, text: str) -> InputError:
    path = write(folder, text)
    with pytest.raises(InputError) as caught:
        load_machine(path, CLASSES)
    assert str(path) in caught.value.message
    return caught.value


def test_default_is_the_thesis_array() -> None:
    machine = load_machine("default", CLASSES)
    assert machine == Machine(
        name="default",
        np_rows=8,
        np_cols=10,
        rom_words=512,
        memory_bytes=256,
        stack_depth=4,
        mask_depth=15,
        timing={"sample": 256, "output": Cost(per_row=1)},
        default_cycles=1,
        sensor=Sensor(0, 0.0, 1),
        link=Link(2, 8, 8, 2, 100),
        summary="The thesis's array; one cycle per instruction except where a device is slower.",
    )
    assert (machine.rows, machine.cols, machine.geometry) == (64, 80, (8, 10))
    assert machine.is_default


def test_cycles_by_class() -> None:
    default, conservative = (load_machine(name, CLASSES) for name in BUILTIN)
    cycles = {name: (default.cycles(name), conservative.cycles(name)) for name in CLASSES}
    assert cycles == {
        "move": (1, 1),
        "alu": (1, 1),
        "memory": (1, 2),
        "neighbour": (1, 2),
        "mask": (1, 1),
        "branch": (1, 2),
        "global_or": (1, 4),
        "sample": (256, 512),
        "output": (8, 16),
        "input": (1, 16),
        "control": (1, 1),
    }


def test_reading_out_takes_longer_on_more_rows(tmp_path: Path) -> None:
    """`output` took 8 cycles on any array, as `npchip compare` on a VGA array showed."""
    big = load_machine(write(tmp_path, BIG), CLASSES)
    slow = load_machine(write(tmp_path, BIG.replace("default", "conservative")), CLASSES)
    assert (big.cycles("output"), big.cycles("input")) == (16, 1)
    assert (slow.cycles("output"), slow.cycles("input"), slow.cycles("global_or")) == (32, 32, 4)
    text = f"{BIG}timing: {{default: {{per_col: 2}}, alu: {{fixed: 3, per_row: 1, per_col: 5}}}}\n"
    mixed = load_machine(write(tmp_path, text), CLASSES)
    assert (mixed.cycles("move"), mixed.cycles("alu"), mixed.cycles("output")) == (40, 119, 16)


@pytest.mark.parametrize(
    ("cost", "code", "message"),
    [
        ("{}", "NP205", "timing.branch: 0 cycles on 8 x 10 NPs, expected a whole number from 1"),
        ("{fixed: 0, per_row: 0}", "NP205", "timing.branch: 0 cycles on 8 x 10 NPs"),
        ("{per_row: 1_000_000}", "NP205", "timing.branch: 8,000,000 cycles on 8 x 10 NPs"),
        ("{per_row: -1}", "NP205", "timing.branch.per_row: expected a whole number from 0"),
        ("{per_row: 0.5}", "NP204", "timing.branch.per_row: expected a whole number"),
        ("{per_rows: 1}", "NP203", "has no per_rows: it takes fixed, per_row, per_col"),
        ("[1]", "NP204", "timing.branch: expected a whole number from 1"),
    ],
)
def test_a_cost_that_makes_no_sense(tmp_path: Path, cost: str, code: str, message: str) -> None:
    error = failure(tmp_path, f"extends: default\ntiming:\n  branch: {cost}\n")
    assert error.code == code
    assert f"mine.yaml:3: {message}" in error.message.replace("branch has", "has")


def test_conservative_differs_only_in_timing_and_link() -> None:
    default, conservative = (load_machine(name) for name in BUILTIN)
    assert conservative.link == Link(16, 10, 8, 4, 2000)
    restored = replace(
        conservative,
        name="default",
        timing=default.timing,
        link=default.link,
        summary=default.summary,
    )
    assert restored == default
    assert not conservative.is_default


def test_only_the_unchanged_default_is_default() -> None:
    default = load_machine("default")
    assert not replace(default, np_rows=16).is_default
    assert not replace(default, default_cycles=2).is_default


def test_a_file_states_what_it_changes(tmp_path: Path) -> None:
    machine = load_machine(write(tmp_path, BIG), CLASSES)
    default = load_machine("default")
    assert machine.geometry == (16, 20)
    assert machine.name == "mine.yaml"
    assert machine.summary == "default with its own geometry"
    assert machine.timing == default.timing
    assert not machine.is_default


def test_a_file_named_default_is_not_the_default(tmp_path: Path) -> None:
    machine = load_machine(write(tmp_path, "extends: default\n", "default.yaml"))
    assert machine.name == "default.yaml"
    assert machine.summary == "as default"
    assert not machine.is_default


def test_timing_is_changed_class_by_class(tmp_path: Path) -> None:
    text = "extends: conservative\ntiming:\n  branch: 3\n  default: 5\n"
    machine = load_machine(write(tmp_path, text), CLASSES)
    assert [machine.cycles(name) for name in ("branch", "alu", "sample")] == [3, 5, 512]


def test_a_file_without_extends_states_everything(tmp_path: Path) -> None:
    text = """
summary: A small one.
geometry: {np_rows: 2, np_cols: 3}
memory: {rom_words: 64, np_bytes: 128, return_stack: 1, mask_depth: 2}
timing: {default: 3}
sensor: {fixed_pattern: 9, noise_rms: 1.5, seed: 0}
link: {serial_bit: 1, serial_byte: 11, parallel_bits: 64, parallel_word: 3, host_latency: 0}
"""
    machine = load_machine(str(write(tmp_path, text)))
    assert (machine.rows, machine.cols, machine.memory_bytes) == (16, 24, 128)
    assert machine.sensor == Sensor(9, 1.5, 0)
    assert machine.link == Link(1, 11, 64, 3, 0)
    assert machine.cycles("sample") == 3


def test_a_machine_is_returned_as_it_is_and_can_be_a_key() -> None:
    machine = replace(load_machine("default"), name="other")
    assert load_machine(machine) is machine
    assert {machine: 1}[machine] == 1


LIMITS = [
    ("geometry", "np_rows", 1, 256),
    ("geometry", "np_cols", 1, 256),
    ("memory", "rom_words", 1, 1024),
    ("memory", "return_stack", 1, 16),
    ("memory", "mask_depth", 1, 15),
    ("timing", "default", 1, 1_000_000),
    ("timing", "branch", 1, 1_000_000),
    ("sensor", "fixed_pattern", 0, 255),
    ("sensor", "noise_rms", 0, 32),
    ("sensor", "light", 0, 4),
    ("sensor", "seed", 0, 2**32 - 1),
    ("link", "serial_bit", 1, 1_000_000),
    ("link", "serial_byte", 8, 16),
    ("link", "parallel_bits", 1, 64),
    ("link", "parallel_word", 1, 1_000_000),
    ("link", "host_latency", 0, 1_000_000_000),
]


@pytest.mark.parametrize(("section", "key", "low", "high"), LIMITS)
def test_limits_on_both_sides(tmp_path: Path, section: str, key: str, low: int, high: int) -> None:
    text = "extends: default\n{}:\n  {}: {}\n"
    for value in (low, high):
        load_machine(write(tmp_path, text.format(section, key, value)), CLASSES)
    for value in (low - 1, high + 1, 10**30, -(10**30)):
        error = failure(tmp_path, text.format(section, key, value))
        assert error.code == "NP205"
        assert f"mine.yaml:3: {section}.{key}: expected a " in error.message
        assert f"from {low} to {high}" in error.message


@pytest.mark.parametrize("value", [0, 63, 100, 257, 512])
def test_memory_is_one_of_three_sizes(tmp_path: Path, value: int) -> None:
    error = failure(tmp_path, f"extends: default\nmemory: {{np_bytes: {value}}}\n")
    assert error.code == "NP205"
    assert f"expected one of 64, 128, 256, found {value}" in error.message


@pytest.mark.parametrize("value", ["yes", "1.0", "'8'", "[8]", "{a: 8}", "", "2020-01-01"])
def test_only_whole_numbers_count(tmp_path: Path, value: str) -> None:
    error = failure(tmp_path, f"extends: default\ngeometry:\n  np_rows: {value}\n")
    assert error.code == "NP204"
    assert "mine.yaml:3: geometry.np_rows: expected a whole number from 1 to 256" in error.message


@pytest.mark.parametrize("value", [".nan", ".inf", "-.inf", "1e300", "-0.1", "32.01"])
def test_noise_is_a_finite_number(tmp_path: Path, value: str) -> None:
    assert failure(tmp_path, f"extends: default\nsensor: {{noise_rms: {value}}}\n").code in (
        "NP204",  # YAML 1.1 reads 1e300 as text
        "NP205",
    )


MISTAKES = [
    ("geometri: {}", "NP203", "mine.yaml:1: a machine has no geometri", "'geometry'"),
    (
        "extends: default\nmemory:\n  np_byte: 1",
        "NP203",
        "mine.yaml:3: memory has no np_byte",
        "'np_bytes'",
    ),
    ("extends: default\ntiming: {brunch: 2}", "NP207", "mine.yaml:2: unknown timing", "'branch'"),
    ("extends: default\ntiming: {defult: 2}", "NP207", "mine.yaml:2: unknown", "'default'"),
    ("extends: conservativ", "NP208", "mine.yaml:1: extends", "'conservative'"),
    ("extends: mine.yaml", "NP208", "found 'mine.yaml'", ""),
    ("extends: [default]", "NP208", "found ['default']", ""),
    ("extends:", "NP208", "found nothing", ""),
    ("extends: default\ngeometry: 8", "NP204", "mine.yaml:2: geometry: expected a mapping", ""),
    ("extends: default\ngeometry: [8, 10]", "NP204", "expected a mapping", ""),
    ("extends: default\nsummary: 8", "NP204", "summary: expected a line of text, found 8", ""),
    ("extends: default\nsummary: ''", "NP204", "summary: expected a line of text", ""),
    ("summary: x", "NP206", "geometry lacks np_rows, np_cols", "extends: default"),
    ("summary: x\ngeometry: {np_rows: 8}", "NP206", "geometry lacks np_cols", "extends"),
    ("extends: default\nextends: default", "NP201", "mine.yaml:2: 'extends' is given twice", ""),
    ("- a list", "NP201", "expected a mapping", ""),
    ("", "NP201", "expected a mapping", ""),
    ("a: [", "NP201", "mine.yaml:", ""),
    ("a: &x 1\nb: *x", "NP201", "aliases", ""),
]


@pytest.mark.parametrize(("text", "code", "message", "hint"), MISTAKES)
def test_mistakes(tmp_path: Path, text: str, code: str, message: str, hint: str) -> None:
    error = failure(tmp_path, text)
    assert error.code == code
    assert message in error.message
    assert hint in (error.hint or "")


def test_everything_but_the_summary_is_not_enough(tmp_path: Path) -> None:
    text = """
geometry: {np_rows: 2, np_cols: 3}
memory: {rom_words: 64, np_bytes: 128, return_stack: 1, mask_depth: 2}
timing: {default: 3}
sensor: {fixed_pattern: 9, noise_rms: 1.5, seed: 0}
link: {serial_bit: 1, serial_byte: 8, parallel_bits: 1, parallel_word: 1, host_latency: 0}
"""
    error = failure(tmp_path, text)
    assert (error.code, "lacks summary" in error.message) == ("NP206", True)


def test_timing_classes_are_free_where_no_instruction_set_is_given(tmp_path: Path) -> None:
    path = write(tmp_path, "extends: default\ntiming: {multiply: 4}\n")
    assert load_machine(path).cycles("multiply") == 4
    assert load_machine(path, {*CLASSES, "multiply"}).cycles("multiply") == 4


@pytest.mark.parametrize("name", ["defualt", "fast", "", "a\0b", "x" * 5000])
def test_unknown_machine(name: str) -> None:
    with pytest.raises(InputError) as caught:
        load_machine(name)
    assert caught.value.code == "NP202"
    assert "default, conservative" in caught.value.message
    if name == "defualt":
        assert caught.value.hint == "did you mean 'default'?"


@pytest.mark.parametrize(
    "name", ["none.yaml", "no/such/file.yml", "a\0b.yaml", "x" * 5000 + ".yaml", "/dev/null"]
)
def test_no_such_file(name: str) -> None:
    with pytest.raises(InputError) as caught:
        load_machine(Path(name))
    assert caught.value.code == "NP201"
    assert "no such file" in caught.value.message


def test_a_directory_and_foreign_bytes_are_no_machine(tmp_path: Path) -> None:
    (tmp_path / "dir.yaml").mkdir()
    (tmp_path / "bytes.yaml").write_bytes(b"\xff\xfe\0\x80")
    for name in ("dir.yaml", "bytes.yaml"):
        with pytest.raises(InputError) as caught:
            load_machine(str(tmp_path / name))
        assert caught.value.code == "NP201"


_LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
_KEYS = st.sampled_from(
    ["extends", "geometry", "memory", "timing", "sensor", "link", "summary", "np_rows", "sample"]
)


@settings(max_examples=100, deadline=None)
@given(
    st.dictionaries(
        _KEYS, _LEAVES | st.lists(_LEAVES, max_size=2) | st.dictionaries(_KEYS, _LEAVES)
    )
    | st.text()
)
def test_any_content_gives_a_machine_or_an_input_error(
    tmp_path_factory: pytest.TempPathFactory, content: object
) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzz.yaml"
    text = content if isinstance(content, str) else repr(content)  # repr is nearly YAML's flow
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        machine = load_machine(path, CLASSES)
    except InputError as error:
        assert error.code.startswith("NP20")  # noqa: PT017 - either outcome is right
    else:
        assert machine.name == "fuzz.yaml"
