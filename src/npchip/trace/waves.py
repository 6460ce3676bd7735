"""A trace as a value change dump (IEEE 1364)."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from vcd import VCDWriter

from npchip.base.errors import InputError

if TYPE_CHECKING:
    from npchip.run.chip import Chip
    from npchip.trace.record import NP, Event

_GCU = {"pc": 9, "frame": 32, "depth": 4}
_NP = {"active": 1, "Z": 1, "C": 1} | {f"r{number}": 8 for number in range(16)}
_MEMORY = re.compile(r"mem\[(0[xX][0-9a-fA-F]+|\d+)\]", re.ASCII)


def signals(names: Sequence[str], memory_bytes: int) -> list[str]:
    """Return the signals that a user names; all except the memory if there are no names.

    Raises:
        InputError: NP612, there is no such signal.
    """
    found: list[str] = []
    for name in names or [*_GCU, "instruction", *_NP]:
        match = _MEMORY.fullmatch(name)
        plain = f"mem[{int(match[1], 0)}]" if match else name
        known = plain in {*_GCU, *_NP, "instruction"}
        if not known and not (match and int(match[1], 0) < memory_bytes):
            raise InputError(
                "NP612",
                f"--signal {name[:40]}: there is no such signal",
                hint="pc, frame, depth, instruction; of each NP r0 to r15, Z, C, active, mem[18]",
            )
        if plain not in found:
            found.append(plain)
    return found


class Waves:
    """Collects events as a dump; a unit of time is a cycle.

    Args:
        chip: the chip at the start of the trace.
        nps: the chosen NPs.
        names: signals, from `signals`.
    """

    def __init__(self, chip: Chip, nps: Sequence[NP], names: Sequence[str]) -> None:
        self._chip = chip
        self._nps = nps
        self._buffer = io.StringIO()
        self._writer = VCDWriter(
            self._buffer,
            timescale="1 ns",  # the format has no cycles
            date="",  # the same dump every day
            version="npchip",
            comment=f"{chip.program.name} on machine {chip.machine.name}: 1 ns stands for 1 cycle",
            init_timestamp=chip.cycles,
        )
        self._vars: list[tuple[str, NP | None, Any]] = []
        for name in names:
            if name == "instruction":
                var = self._writer.register_var("gcu", name, "string", init="")
                self._vars.append((name, None, var))
            elif name in _GCU:
                value = self._value(name, None)
                var = self._writer.register_var("gcu", name, "wire", size=_GCU[name], init=value)
                self._vars.append((name, None, var))
            else:
                for np in nps:
                    scope = f"np_{np[0]}_{np[1]}"
                    size, init = _NP.get(name, 8), self._value(name, np)
                    # Viewers take brackets for the bits of a vector.
                    shown = name.replace("[", "_").rstrip("]")
                    var = self._writer.register_var(scope, shown, "wire", size=size, init=init)
                    self._vars.append((name, np, var))

    def _value(self, name: str, np: NP | None) -> int:
        chip = self._chip
        match name:
            case "pc":
                return chip.pc
            case "frame":
                return max(0, chip.frames_taken - 1)
            case "depth":
                return chip.depth
        assert np is not None
        if name == "active":
            return int(chip.active[np])
        if name in chip.flags:
            return int(chip.flags[name][np])
        byte = _MEMORY.fullmatch(name)
        plane = chip.memory[int(byte[1])] if byte else chip.registers[int(name[1:])]
        return int(plane[np])

    def add(self, event: Event) -> None:
        """Add an event directly after its execution; its changes appear at its end."""
        for name, _, var in self._vars:
            if name == "instruction":
                self._writer.change(var, event.cycle, event.text)
        for name, np, var in self._vars:
            if name != "instruction":
                self._writer.change(var, event.cycle + event.cycles, self._value(name, np))

    def text(self) -> str:
        """Return the whole dump."""
        self._writer.close()
        return self._buffer.getvalue()
