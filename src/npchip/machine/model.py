"""Machines: geometry, memories, timing, sensor and link, read from YAML files."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

from npchip.base.errors import InputError
from npchip.base.frozen import FrozenMap
from npchip.base.section import Codes, Section
from npchip.base.suggest import shown, suggestion
from npchip.base.yaml import Located, load_mapping, read_mapping

PIXELS = 8
"""Pixels along each side of an NP (thesis: 8 x 8 pixels each)."""

BUILTIN = ("default", "conservative")
"""Names of the machines that ship with the package."""

_SHIPPED = ", ".join(BUILTIN)


@dataclass(frozen=True)
class Sensor:
    """Offsets, noise and light of the pixels (decision; see `npchip.machine.sensor`).

    Attributes:
        fixed_pattern: largest offset of a pixel in LSB, 0..255; offsets are 0..fixed_pattern.
        noise_rms: temporal noise of one conversion in LSB, 0..32.
        seed: 0..2**32-1; another seed is another chip.
        light: 0..4; how much of the light of a frame reaches the pixels, 1 for all of it.
    """

    fixed_pattern: int
    noise_rms: float
    seed: int
    light: float = 1.0


@dataclass(frozen=True)
class Link:
    """The link between two cameras, or a camera and a processor (decision; see `npchip.host.rig`).

    Attributes:
        serial_bit: cycles of the chip for a bit on the serial line.
        serial_byte: bits on the line for a byte, start and stop bits included, 8..16.
        parallel_bits: lines of the parallel link, 1..64.
        parallel_word: cycles for one transfer on all lines.
        host_latency: cycles from the last byte received by a separate processor to its result.
    """

    serial_bit: int
    serial_byte: int
    parallel_bits: int
    parallel_word: int
    host_latency: int


class Cost(NamedTuple):
    """Cycles that depend on the array: a fixed part, and some for each row and column of NPs."""

    fixed: int = 0
    per_row: int = 0
    per_col: int = 0

    def __str__(self) -> str:
        parts = ((self.fixed, ""), (self.per_row, " a row"), (self.per_col, " a column"))
        return " + ".join(f"{cycles}{unit}" for cycles, unit in parts if cycles)


@dataclass(frozen=True, repr=False)
class Machine:
    """One chip. `load_machine` checks every value; change one with `dataclasses.replace`.

    Attributes:
        name: name of a shipped machine, or the file's name with its suffix.
        np_rows: rows of NPs, 1..256 (thesis: 8; row numbers are 8 bits, a decision).
        np_cols: columns of NPs, 1..256 (thesis: 10).
        rom_words: program words, 1..1024 (thesis: 512; more are for studies).
        memory_bytes: memory of an NP: 64, 128 or 256 bytes (decision).
        stack_depth: entries of the return stack, 1..16 (decision).
        mask_depth: deepest nesting of masks, 1..15 (decision: a 4-bit counter).
        timing: cycles by timing class, for classes that differ from `default_cycles` (decision);
            ask `cycles`.
        default_cycles: cycles of every other timing class.
        sensor: offsets, noise and light.
        link: the link to another camera or a processor.
        summary: a description in one line.
    """

    name: str
    np_rows: int
    np_cols: int
    rom_words: int
    memory_bytes: int
    stack_depth: int
    mask_depth: int
    timing: Mapping[str, int | Cost] = field(hash=False)
    default_cycles: int | Cost
    sensor: Sensor
    link: Link
    summary: str

    def __repr__(self) -> str:
        return f"<Machine {self.name!r}: {self.np_rows} x {self.np_cols} NPs>"

    @property
    def rows(self) -> int:
        """Number of rows of pixels."""
        return PIXELS * self.np_rows

    @property
    def cols(self) -> int:
        """Number of columns of pixels."""
        return PIXELS * self.np_cols

    @property
    def geometry(self) -> tuple[int, int]:
        """Number of NP rows and of NP columns."""
        return self.np_rows, self.np_cols

    @property
    def is_default(self) -> bool:
        """True for the shipped `default`, the only machine that cycle budgets apply to."""
        return self == _shipped("default")

    def cycles(self, timing_class: str) -> int:
        """Return the cycles of an instruction of a timing class."""
        cost = self.timing.get(timing_class, self.default_cycles)
        if not isinstance(cost, Cost):
            return cost
        return cost.fixed + cost.per_row * self.np_rows + cost.per_col * self.np_cols


@dataclass(eq=False)
class _Range:
    """The numbers that a key may have: between two bounds, or one of some `choices`."""

    low: int
    high: int
    fraction: bool = False
    choices: tuple[int, ...] = ()

    def __contains__(self, value: float) -> bool:
        if self.choices:
            return value in self.choices
        return self.low <= value <= self.high  # NaN is in no range

    def __str__(self) -> str:
        if self.choices:
            return f"one of {', '.join(map(str, self.choices))}"
        return f"a {'' if self.fraction else 'whole '}number from {self.low} to {self.high}"


class _Section(Section):
    """A section of a machine file."""

    codes = Codes(unknown="NP203", missing="NP206", type="NP204")

    def check_numbers(self, limits: Mapping[str, _Range]) -> None:
        """Raise an error for a value out of its limits."""
        for key in self.data:
            self.check_number(key, limits[key])

    def check_number(self, key: str, limit: _Range) -> None:
        """Raise an error for a value out of its limit."""
        value = self.data[key]
        kinds = (int, float) if limit.fraction else (int,)
        if isinstance(value, bool) or not isinstance(value, kinds):
            raise self.wrong(key, str(limit), value)
        if value not in limit:
            message = f"{self.prefix}{key}: expected {limit}, found {shown(value)}"
            raise self.error(message, code="NP205", key=key)


# At least 1: a loop of free instructions would never reach a cycle limit.
_CYCLES = _Range(1, 1_000_000)
_PART = _Range(0, 1_000_000)
_SECTIONS: Mapping[str, Mapping[str, _Range]] = {
    "geometry": {"np_rows": _Range(1, 256), "np_cols": _Range(1, 256)},
    "memory": {
        "rom_words": _Range(1, 1024),
        "np_bytes": _Range(64, 256, choices=(64, 128, 256)),
        "return_stack": _Range(1, 16),
        "mask_depth": _Range(1, 15),
    },
    "timing": {"default": _CYCLES},  # and any timing class of the instruction set
    "sensor": {
        "fixed_pattern": _Range(0, 255),
        "noise_rms": _Range(0, 32, fraction=True),
        "seed": _Range(0, 2**32 - 1),
        "light": _Range(0, 4, fraction=True),
    },
    "link": {
        "serial_bit": _CYCLES,
        "serial_byte": _Range(8, 16),
        "parallel_bits": _Range(1, 64),
        "parallel_word": _CYCLES,
        "host_latency": _Range(0, 1_000_000_000),
    },
}
_OPTIONAL: Mapping[str, Mapping[str, Any]] = {"sensor": {"light": 1.0}}
"""Keys that a file without ``extends`` may leave out: they came later than such files."""
_PARTS = ("geometry", "memory")
"""Sections whose values are attributes of a machine, some with another name."""
_FIELDS = {"np_bytes": "memory_bytes", "return_stack": "stack_depth"}


def load_machine(
    spec: str | Path | Machine, timing_classes: Collection[str] | None = None
) -> Machine:
    """Return a machine by name or from a file.

    Args:
        spec: a name in `BUILTIN`, the path of a ``.yaml`` or ``.yml`` file (a `Path` may have
            any suffix), or a machine, which is returned unchanged.
        timing_classes: the timing classes that a file may use; None allows any.

    Raises:
        InputError: NP201 unreadable or not YAML, NP202 unknown machine, NP203 unknown key,
            NP204 wrong type, NP205 out of range, NP206 a key is missing, NP207 unknown timing
            class, NP208 ``extends`` names no shipped machine. Messages name file and line.
    """
    if isinstance(spec, Machine):
        return spec
    if isinstance(spec, str):
        if spec in BUILTIN:
            return _shipped(spec)
        if not spec.endswith((".yaml", ".yml")):
            raise InputError(
                "NP202",
                f"unknown machine '{spec}': the shipped ones are {_SHIPPED}",
                hint=suggestion(spec, BUILTIN)
                or "name a file that ends in .yaml for one of your own",
            )
    path = Path(spec)
    try:
        regular = path.is_file()
    except OSError:  # a name too long, a directory that may not be entered
        regular = False
    if not regular:
        raise InputError(
            "NP201",
            f"machine file {path}: no such file",
            hint=suggestion(path.stem, BUILTIN) or f"the shipped machines are {_SHIPPED}",
        )
    return machine_of(read_mapping(path, "NP201"), str(path), path.name, timing_classes)


def parse_machine(text: str, name: str, timing_classes: Collection[str] | None = None) -> Machine:
    """Return the machine that the text of a file describes; see `load_machine`.

    Args:
        text: the text.
        name: the name of the file, in messages too.
        timing_classes: as for `load_machine`.

    Raises:
        InputError: as `load_machine`.
    """
    return machine_of(load_mapping(text, name, "NP201"), name, name, timing_classes)


@cache
def _shipped(name: str) -> Machine:
    file = files("npchip.machine").joinpath(f"{name}.yaml")
    data = load_mapping(file.read_text("utf-8"), file.name, "NP201")
    return machine_of(data, file.name, name, None)


def machine_of(
    data: Located, file: str, name: str, timing_classes: Collection[str] | None
) -> Machine:
    """Return the machine that a mapping in a file, called `file` in messages, describes."""
    top = _Section(data, file, "a machine")
    top.check_keys((), ("summary", "extends", *_SECTIONS))
    base = _base(top) if "extends" in data else None
    sections = {key: _section(top, key, timing_classes) for key in _SECTIONS if key in data}
    values = sections_of(base) if base else {key: {**_OPTIONAL.get(key, {})} for key in _SECTIONS}
    for key in _SECTIONS:
        values[key] |= sections.get(key, {})
        missing = [name for name in _SECTIONS[key] if name not in values[key]]
        if missing:
            raise InputError(
                "NP206",
                f"{file}: {key} lacks {', '.join(missing)}",
                hint="state every value, or add 'extends: default' to change only some",
            )
    timing = dict(values["timing"])
    default_cycles = timing.pop("default")
    sensor = values["sensor"]
    machine = Machine(
        name=name,
        **{_FIELDS.get(key, key): value for part in _PARTS for key, value in values[part].items()},
        timing=FrozenMap(timing),
        default_cycles=default_cycles,
        sensor=Sensor(**sensor | {key: float(sensor[key]) for key in ("noise_rms", "light")}),
        link=Link(**values["link"]),
        summary=_summary(top, base, [key for key, section in sections.items() if section]),
    )
    _check_costs(top, machine)
    return machine


def _check_costs(top: _Section, machine: Machine) -> None:
    """Check what the costs of a file's timing classes come to on its array."""
    for key in top.data.get("timing", ()):
        if (cycles := machine.cycles(key)) not in _CYCLES:
            rows, cols = machine.geometry
            message = f"timing.{key}: {cycles:,} cycles on {rows} x {cols} NPs, expected {_CYCLES}"
            raise top.section("timing").error(message, code="NP205", key=key)


def sections_of(machine: Machine) -> dict[str, dict[str, Any]]:
    """Return the sections of a machine's file: the inverse of `machine_of`."""
    return {
        **{
            part: {key: getattr(machine, _FIELDS.get(key, key)) for key in _SECTIONS[part]}
            for part in _PARTS
        },
        "timing": {"default": machine.default_cycles, **machine.timing},
        "sensor": asdict(machine.sensor),
        "link": asdict(machine.link),
    }


def _base(top: _Section) -> Machine:
    """Return the machine that a file extends, a shipped one, so that files cannot form a loop."""
    name = top.data["extends"]
    if name not in BUILTIN:
        message = f"extends: expected a shipped machine ({_SHIPPED}), found {shown(name)}"
        raise top.error(message, code="NP208", key="extends", hint=suggestion(name, BUILTIN))
    return _shipped(name)


def _summary(top: _Section, base: Machine | None, changed: list[str]) -> str:
    """Return the file's summary, by default the sections that it changes."""
    if "summary" not in top.data:
        if base is None:
            message = f"{top.file}: lacks summary"
            raise InputError("NP206", message, hint="say in one line what it is")
        return f"{base.name} with its own {', '.join(changed)}" if changed else f"as {base.name}"
    summary = " ".join(str(top.get("summary", str, what="a line of text")).split())
    if not summary:
        raise top.wrong("summary", "a line of text", top.data["summary"])
    return summary


def _section(top: _Section, name: str, timing_classes: Collection[str] | None) -> Mapping[str, Any]:
    """Return the values of a section, checked."""
    section = top.section(name, prefix=f"{name}.")
    if name != "timing":
        section.check_keys((), _SECTIONS[name])
    elif timing_classes is not None:
        _check_timing_classes(section, timing_classes)
    if name == "timing":
        return {key: _cost(section, key) for key in section.data}
    section.check_numbers(_SECTIONS[name])
    return section.data


def _cost(section: _Section, key: str) -> int | Cost:
    """Return the cycles of a timing class: a number, or a mapping with the parts of a `Cost`."""
    value = section.data[key]
    if isinstance(value, Located):
        parts = section.section(key, prefix=f"timing.{key}.")
        parts.check_keys((), Cost._fields)
        parts.check_numbers(dict.fromkeys(Cost._fields, _PART))
        return Cost(**parts.data)
    section.check_number(key, _CYCLES)
    return int(value)


def _check_timing_classes(section: _Section, known: Collection[str]) -> None:
    for key in section.data:
        if key != "default" and key not in known:
            raise section.error(
                f"unknown timing class '{key}': the instruction set has {', '.join(sorted(known))}",
                code="NP207",
                key=key,
                hint=suggestion(key, ["default", *known]),
            )
