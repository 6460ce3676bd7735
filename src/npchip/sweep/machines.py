"""The machines of a sweep: by name, by file, or written out with lists as axes."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from npchip.base.yaml import Located
from npchip.isa import load_isa
from npchip.machine import BUILTIN, load_machine
from npchip.machine.model import Cost, Machine, machine_of, sections_of
from npchip.sweep.axes import AxisError, Value, is_axis, values
from npchip.sweep.model import Chip
from npchip.sweep.section import SweepSection


class _Axis(NamedTuple):
    """A key of a machine with several values: the keys that lead to it."""

    keys: tuple[str, ...]
    values: tuple[Any, ...]


def read_machines(top: SweepSection, folder: Path) -> tuple[Chip, ...]:
    """Return the machines in the key ``machines``, those of each axis one after the other.

    Args:
        top: the sweep file.
        folder: its folder, from which paths lead.

    Raises:
        InputError: an entry is no machine; errors as `load_machine`.
    """
    if "machines" not in top.data:
        return (Chip("default", load_machine("default")),)
    classes = load_isa().timing_classes
    made: list[tuple[str, Machine]] = []
    axes: dict[tuple[str, ...], None] = {}
    for item in top.entries("machines", "a list of machines"):
        if isinstance(item, Located):
            found = [*_axes(top, item, ())]
            axes |= dict.fromkeys(axis.keys for axis in found)
            label = str(item.get("name") or item.get("extends") or "machine")
            for chosen in product(*(axis.values for axis in found)):
                data = _chosen(item, found, chosen)
                made.append((label, machine_of(data, str(top.file), label, classes)))
        elif isinstance(item, str):
            path = item if item in BUILTIN else folder / item
            made.append((Path(item).stem, load_machine(str(path), classes)))
        else:
            raise top.wrong("machines", "names, files or mappings", item)
    names = _names([*axes])
    return tuple(
        Chip(label, machine, {name: _value(machine, keys) for name, keys in names.items()})
        for label, machine in made
    )


def _axes(top: SweepSection, data: Located, outer: tuple[str, ...]) -> Iterator[_Axis]:
    for key, value in data.items():
        keys = (*outer, key)
        if isinstance(value, Located):
            yield from _axes(top, value, keys)
        elif outer and is_axis(value):
            try:
                yield _Axis(keys, values(value))
            except AxisError as error:
                place = f"{top.file}:{data.lines[key]}: "
                raise top.error_type("NP645", f"{place}{'.'.join(keys)}: {error}") from None


def _chosen(data: Located, axes: list[_Axis], chosen: tuple[Any, ...]) -> Located:
    """Return the mapping of one machine, with one value along each axis."""
    copy = deepcopy(data)
    copy.pop("name", None)
    for axis, value in zip(axes, chosen, strict=True):
        inner: Any = copy
        for key in axis.keys[:-1]:
            inner = inner[key]
        inner[axis.keys[-1]] = value
    return copy


def _names(axes: list[tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
    """Return the column of each axis: its last key, or all where that is not enough."""
    lasts = [keys[-1] for keys in axes]
    return {
        keys[-1] if lasts.count(keys[-1]) == 1 and keys[-1] != "seed" else ".".join(keys): keys
        for keys in axes
    }


def _value(machine: Machine, keys: tuple[str, ...]) -> Value:
    """Return what a machine has in the place of an axis."""
    section, name, *part = keys
    if section == "timing":
        cost = machine.timing.get(name, machine.default_cycles)
        whole = cost if isinstance(cost, Cost) else Cost(cost)
        return (
            getattr(whole, part[0]) if part else whole.fixed if whole[1:] == (0, 0) else str(cost)
        )
    value: Value = sections_of(machine)[section][name]
    return value
