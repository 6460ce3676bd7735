"""A machine: geometry, memories, cycles by timing class and sensor, read from a YAML file."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss
from npchip.base.yaml import Located, load_mapping, read_mapping

PIXELS = 8
"""Pixels along each side of an NP (thesis: 8 x 8 pixels each)."""

BUILTIN = ("default", "conservative")
"""Names of the machines that ship with the package."""


@dataclass(frozen=True)
class Sensor:
    """What the pixels add to the light (decision; see `npchip.machine.sensor`).

    Attributes:
        fixed_pattern: largest offset of a pixel in LSB, 0..255; offsets are 0..fixed_pattern.
        noise_rms: temporal noise of one conversion in LSB, 0..32.
        seed: 0..2**32-1; another seed is another chip.
    """

    fixed_pattern: int
    noise_rms: float
    seed: int


@dataclass(frozen=True)
class Link:
    """The link between two cameras, or a camera and a processor (decision; see `npchip.host.rig`).

    Attributes:
        serial_bit: cycles of the chip that a bit takes on the serial line.
        serial_byte: bits on the line for a byte, start and stop bits included, 8..16.
        parallel_bits: lines of the parallel link, 1..64.
        parallel_word: cycles for as many bits as there are lines.
        host_latency: cycles from the last byte that reaches a separate processor to its result.
    """

    serial_bit: int
    serial_byte: int
    parallel_bits: int
    parallel_word: int
    host_latency: int


@dataclass(frozen=True)
class Machine:
    """One chip. `load_machine` checks every value; change one with `dataclasses.replace`.

    Attributes:
        name: name of a shipped machine, or the file's name with its suffix.
        np_rows: rows of NPs, 1..256 (thesis: 8; row numbers are 8 bits, a decision).
        np_cols: columns of NPs, 1..256 (thesis: 10).
        rom_words: program words, 1..512 (thesis: 512).
        memory_bytes: memory of an NP: 64, 128 or 256 bytes (decision).
        stack_depth: entries of the return stack, 1..16 (decision).
        mask_depth: deepest nesting of masks, 1..15 (decision: a 4-bit counter).
        timing: cycles by timing class, for classes that differ from `default_cycles` (decision).
        default_cycles: cycles of every other timing class.
        sensor: offsets and noise.
        link: what joins it to another camera.
        summary: one line for people.
    """

    name: str
    np_rows: int
    np_cols: int
    rom_words: int
    memory_bytes: int
    stack_depth: int
    mask_depth: int
    timing: Mapping[str, int] = field(hash=False)
    default_cycles: int
    sensor: Sensor
    link: Link
    summary: str

    @property
    def rows(self) -> int:
        """Rows of pixels."""
        return PIXELS * self.np_rows

    @property
    def cols(self) -> int:
        """Columns of pixels."""
        return PIXELS * self.np_cols

    @property
    def geometry(self) -> tuple[int, int]:
        """(NP rows, NP columns)."""
        return self.np_rows, self.np_cols

    @property
    def is_default(self) -> bool:
        """Whether this is the shipped `default` unchanged: cycle budgets hold only there."""
        return self == _shipped("default")

    def cycles(self, timing_class: str) -> int:
        """Cycles that an instruction of `timing_class` takes."""
        return self.timing.get(timing_class, self.default_cycles)


@dataclass(eq=False)
class _Range:
    """A whole number between two bounds, or any number where `fraction` is set."""

    low: int
    high: int
    fraction: bool = False

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high  # NaN is in no range

    def __str__(self) -> str:
        return f"a {'' if self.fraction else 'whole '}number from {self.low} to {self.high}"


@dataclass(eq=False)
class _OneOf:
    """One of a few whole numbers."""

    choices: tuple[int, ...]
    fraction: bool = False

    def __contains__(self, value: float) -> bool:
        return value in self.choices

    def __str__(self) -> str:
        return f"one of {', '.join(map(str, self.choices))}"


# At least 1: a free instruction could loop for ever without reaching a cycle limit.
_CYCLES = _Range(1, 1_000_000)
_SECTIONS: Mapping[str, Mapping[str, _Range | _OneOf]] = {
    "geometry": {"np_rows": _Range(1, 256), "np_cols": _Range(1, 256)},
    "memory": {
        "rom_words": _Range(1, 512),
        "np_bytes": _OneOf((64, 128, 256)),
        "return_stack": _Range(1, 16),
        "mask_depth": _Range(1, 15),
    },
    "timing": {"default": _CYCLES},  # and any timing class of the instruction set
    "sensor": {
        "fixed_pattern": _Range(0, 255),
        "noise_rms": _Range(0, 32, fraction=True),
        "seed": _Range(0, 2**32 - 1),
    },
    "link": {
        "serial_bit": _CYCLES,
        "serial_byte": _Range(8, 16),
        "parallel_bits": _Range(1, 64),
        "parallel_word": _CYCLES,
        "host_latency": _Range(0, 1_000_000_000),
    },
}


def load_machine(
    spec: str | Path | Machine, timing_classes: Collection[str] | None = None
) -> Machine:
    """Load a machine by name or from a file.

    Args:
        spec: a name in `BUILTIN`, the path of a ``.yaml`` or ``.yml`` file (a `Path` may have
            any suffix), or a machine, which is returned as it is.
        timing_classes: timing classes of the instruction set; any other in the file is an error.
            None accepts all.

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
                f"unknown machine '{spec}': the shipped ones are {_listed(BUILTIN)}",
                hint=_near(spec, BUILTIN) or "name a file that ends in .yaml for one of your own",
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
            hint=_near(path.stem, BUILTIN) or f"the shipped machines are {_listed(BUILTIN)}",
        )
    return _parse(read_mapping(path, "NP201"), str(path), path.name, timing_classes)


@cache
def _shipped(name: str) -> Machine:
    file = Path(__file__).with_name(f"{name}.yaml")
    return _parse(load_mapping(file.read_text("utf-8"), file.name, "NP201"), file.name, name, None)


def _parse(data: Located, file: str, name: str, timing_classes: Collection[str] | None) -> Machine:
    """Make a machine of a file's content.

    Args:
        data: what the file holds.
        file: how messages call it.
        name: name of the machine.
        timing_classes: as for `load_machine`.
    """
    _check_keys(data, ("summary", "extends", *_SECTIONS), data, file)
    base: Machine | None = None
    if "extends" in data:
        base = _base(data["extends"], f"{file}:{data.lines['extends']}")
    sections = {key: _section(data, key, file, timing_classes) for key in _SECTIONS}
    values = _flat(base) if base else {key: {} for key in _SECTIONS}
    for key, section in sections.items():
        values[key] |= section
        missing = [name for name in _SECTIONS[key] if name not in values[key]]
        if missing:
            raise InputError(
                "NP206",
                f"{file}: {key} lacks {_listed(missing)}",
                hint="state every value, or add 'extends: default' to change only some",
            )
    timing = dict(values["timing"])
    default_cycles = timing.pop("default")
    memory, sensor = values["memory"], values["sensor"]
    return Machine(
        name=name,
        np_rows=values["geometry"]["np_rows"],
        np_cols=values["geometry"]["np_cols"],
        rom_words=memory["rom_words"],
        memory_bytes=memory["np_bytes"],
        stack_depth=memory["return_stack"],
        mask_depth=memory["mask_depth"],
        timing=MappingProxyType(timing),
        default_cycles=default_cycles,
        sensor=Sensor(sensor["fixed_pattern"], float(sensor["noise_rms"]), sensor["seed"]),
        link=Link(**values["link"]),
        summary=_summary(data, file, base, [key for key in _SECTIONS if sections[key]]),
    )


def _flat(machine: Machine) -> dict[str, dict[str, Any]]:
    """The values of a machine as its file has them: the inverse of `_parse`."""
    return {
        "geometry": {"np_rows": machine.np_rows, "np_cols": machine.np_cols},
        "memory": {
            "rom_words": machine.rom_words,
            "np_bytes": machine.memory_bytes,
            "return_stack": machine.stack_depth,
            "mask_depth": machine.mask_depth,
        },
        "timing": {"default": machine.default_cycles, **machine.timing},
        "sensor": {
            "fixed_pattern": machine.sensor.fixed_pattern,
            "noise_rms": machine.sensor.noise_rms,
            "seed": machine.sensor.seed,
        },
        "link": asdict(machine.link),
    }


def _base(name: Any, place: str) -> Machine:
    """The machine that a file extends: only shipped ones, so that no chain of files can loop."""
    if name not in BUILTIN:
        raise InputError(
            "NP208",
            f"{place}: extends: expected a shipped machine ({_listed(BUILTIN)}), "
            f"found {_shown(name)}",
            hint=_near(name, BUILTIN),
        )
    return _shipped(name)


def _summary(data: Located, file: str, base: Machine | None, changed: list[str]) -> str:
    """The file's summary, or what it changes: its base's own summary would mislead."""
    if "summary" not in data:
        if base is None:
            raise InputError("NP206", f"{file}: lacks summary", hint="say in one line what it is")
        return f"{base.name} with its own {_listed(changed)}" if changed else f"as {base.name}"
    summary = data["summary"]
    if not isinstance(summary, str) or not summary.strip():
        raise _wrong_type(f"{file}:{data.lines['summary']}", "summary", "a line of text", summary)
    return " ".join(summary.split())


def _section(
    data: Located, name: str, file: str, timing_classes: Collection[str] | None
) -> dict[str, Any]:
    """The checked values that a file states in one section; empty without that section."""
    if name not in data:
        return {}
    section = data[name]
    if not isinstance(section, Located):
        raise _wrong_type(f"{file}:{data.lines[name]}", name, "a mapping (key: value)", section)
    limits = _SECTIONS[name]
    if name != "timing":
        _check_keys(section, limits, section, file)
    elif timing_classes is not None:
        _check_timing_classes(section, timing_classes, file)
    for key, value in section.items():
        place = f"{file}:{section.lines[key]}"
        _check_number(value, limits.get(key, _CYCLES), place, f"{name}.{key}")
    return dict(section)


def _check_keys(keys: Iterable[str], known: Collection[str], at: Located, file: str) -> None:
    for key in keys:
        if key not in known:
            raise InputError(
                "NP203",
                f"{file}:{at.lines[key]}: unknown key '{key}': expected {_listed(known)}",
                hint=_near(key, known),
            )


def _check_timing_classes(section: Located, known: Collection[str], file: str) -> None:
    for key in section:
        if key != "default" and key not in known:
            raise InputError(
                "NP207",
                f"{file}:{section.lines[key]}: unknown timing class '{key}': "
                f"the instruction set has {_listed(sorted(known))}",
                hint=_near(key, ["default", *known]),
            )


def _check_number(value: Any, limits: _Range | _OneOf, place: str, key: str) -> None:
    kinds = (int, float) if limits.fraction else (int,)
    if isinstance(value, bool) or not isinstance(value, kinds):
        raise _wrong_type(place, key, str(limits), value)
    if value not in limits:
        raise InputError("NP205", f"{place}: {key}: expected {limits}, found {_shown(value)}")


def _wrong_type(place: str, key: str, expected: str, found: Any) -> InputError:
    return InputError("NP204", f"{place}: {key}: expected {expected}, found {_shown(found)}")


def _shown(value: Any) -> str:
    """A value as a message shows it: never a screenful."""
    if value is None:
        return "nothing"
    if isinstance(value, dict | list):
        return "a mapping" if isinstance(value, dict) else "a list"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) > 10**20:
        return "a number of more than 20 digits"  # str() refuses some
    return repr(value)[:60]


def _listed(names: Collection[str]) -> str:
    return ", ".join(names)


def _near(name: Any, known: Iterable[str]) -> str | None:
    near = near_miss(str(name)[:80], known)
    return f"did you mean '{near}'?" if near else None
