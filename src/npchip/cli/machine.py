"""``npchip machine``: show machines side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from npchip.cli.options import machines
from npchip.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Iterable

    from npchip.machine import Machine


@click.command("machine")
@click.argument("names", metavar="[NAME|FILE.yaml]...", nargs=-1, shell_complete=machines)
def command(names: tuple[str, ...]) -> None:
    """Show machines side by side: array, memories, cycles, sensor.

    Without a name: the machines that ship with npchip.

    \b
    Examples:
      npchip machine
      npchip machine default mine.yaml
    """
    from npchip.base.columns import aligned
    from npchip.isa import load_isa
    from npchip.machine import BUILTIN, load_machine

    classes = load_isa().timing_classes
    machines = [load_machine(name, classes) for name in names or BUILTIN]

    columns = [_facts(machine, classes) for machine in machines]
    rows = [(title, *(str(column[title]) for column in columns)) for title in columns[0]]
    text = "".join(f"{line}\n" for line in aligned(rows))
    summaries = "".join(f"{machine.name}: {machine.summary}\n" for machine in machines)
    emit(f"{text}\n{summaries}")


def _cycles(machine: Machine, timing_class: str) -> str:
    cost = machine.timing.get(timing_class, machine.default_cycles)
    cycles = machine.cycles(timing_class)
    return str(cycles) if isinstance(cost, int) else f"{cycles} ({cost})"


def _facts(machine: Machine, classes: Iterable[str]) -> dict[str, object]:
    """Return the column of a machine, by the titles of the rows."""
    sensor, link = machine.sensor, machine.link
    return {
        "": machine.name,
        "NPs": f"{machine.np_rows} x {machine.np_cols}",
        "pixels": f"{machine.rows} x {machine.cols}",
        "program words": machine.rom_words,
        "memory of an NP, bytes": machine.memory_bytes,
        "return stack": machine.stack_depth,
        "open masked regions": machine.mask_depth,
        **{f"cycles: {name}": _cycles(machine, name) for name in classes},
        "sensor: fixed pattern, LSB": sensor.fixed_pattern,
        "sensor: noise, LSB rms": f"{sensor.noise_rms:g}",
        "sensor: seed": sensor.seed,
        "sensor: light": f"{sensor.light:g}",
        "link: serial, cycles a bit": link.serial_bit,
        "link: serial, bits a byte": link.serial_byte,
        "link: parallel, lines": link.parallel_bits,
        "link: parallel, cycles a word": link.parallel_word,
        "link: processor, cycles to a result": link.host_latency,
    }
