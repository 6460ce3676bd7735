"""Make a debugger from the arguments of a launch; the project file gives those left out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from npchip.base.numbers import whole_number
from npchip.base.suggest import near_miss
from npchip.dap.arguments import Arguments, wrong
from npchip.debugger.session import MAX_CYCLES, Debugger
from npchip.frames import open_frames
from npchip.frames.memory import Planes, read_memory
from npchip.language.loading import load
from npchip.machine import Machine
from npchip.run.chip import MAX_CYCLES as MOST_CYCLES

_OWN: Final = ("program", "frames", "machine", "defines", "memory", "fit", "isa", "include")
KNOWN: Final = (*_OWN, "maxCycles", "stopOnEntry", "noDebug")
"""Keys of a launch. Editors add more of their own."""


class Launched(NamedTuple):
    """A program that is ready to be debugged.

    Attributes:
        debugger: at the beginning of the run.
        stop_on_entry: whether to stop there.
        debug: whether to stop at all.
    """

    debugger: Debugger
    stop_on_entry: bool
    debug: bool


def launch(arguments: Arguments, warn: Callable[[str], None]) -> Launched:
    """Load what a launch names.

    Args:
        arguments: those of the launch.
        warn: called with warnings.

    Raises:
        NpchipError: as on the command line; NP358, arguments that make no sense.
    """
    for key in arguments.data:
        near = None if key in KNOWN else near_miss(key, KNOWN)
        if near is not None and near.lower().rstrip("s") == key.lower().rstrip("s"):
            warn(f"warning: launch: '{key}' has no effect: did you mean '{near}'?")
    isa_file = arguments.text("isa", None)
    isa, machine, program = load(
        arguments.text("program"),
        machine=arguments.text("machine", None),
        isa_file=isa_file and Path(isa_file),
        include=[Path(folder) for folder in arguments.texts("include")],
        defines=_defines(arguments.data.get("defines")),
        on_warning=lambda warning: warn(str(warning)),
    )
    clip, fit = arguments.text("frames", None), arguments.text("fit", None)
    if fit not in {None, "crop", "resize"}:
        raise wrong("launch: fit", "crop or resize", fit)
    frames = open_frames(clip, machine.rows, machine.cols, fit) if clip else None
    debugger = Debugger(
        program,
        frames,
        machine,
        isa,
        memory=_memory(arguments.data.get("memory"), machine),
        max_cycles=arguments.number("maxCycles", MAX_CYCLES, 1, MOST_CYCLES),
    )
    if frames is not None and not debugger.names.writers.exposes:
        warn(f"warning: the program takes no frames: {clip} has no effect [NP257]")
    return Launched(debugger, arguments.flag("stopOnEntry"), not arguments.flag("noDebug"))


def _pairs(data: Any, what: str, form: str) -> list[tuple[str, Any]]:
    """Return the pairs of an object, or of a list of texts as options have them."""
    if data is None:
        return []
    if isinstance(data, Mapping):
        return list(data.items())
    if not isinstance(data, list) or not all(isinstance(i, str) and "=" in i for i in data):
        raise wrong(f"launch: {what}", f"an object, or a list of texts {form}", data)
    return [(name.strip(), value.strip()) for name, _, value in (i.partition("=") for i in data)]


def _number(text: Any) -> int | None:
    if isinstance(text, int) and not isinstance(text, bool):
        return text
    return whole_number(text) if isinstance(text, str) else None


def _defines(data: Any) -> dict[str, int]:
    values: dict[str, int] = {}
    for name, given in _pairs(data, "defines", "NAME=VALUE"):
        number = _number(given)
        if number is None:
            raise wrong(f"launch: defines: {name}", "a whole number", given)
        values[name] = number
    return values


def _memory(data: Any, machine: Machine) -> list[Planes]:
    planes: list[Planes] = []
    for text, file in _pairs(data, "memory", "ADDRESS=FILE.npy"):
        address = _number(text)
        if address is None or address < 0:
            raise wrong("launch: memory", "an address from 0 on", text)
        if not isinstance(file, str) or not file:
            raise wrong(f"launch: memory: {text}", "the name of a .npy file", file)
        planes.append((address, read_memory(address, Path(file), machine)))
    return planes
