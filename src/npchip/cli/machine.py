"""``npchip machine``: what a machine file says."""

from __future__ import annotations

import click

from npchip.cli.options import machines
from npchip.cli.output import emit

_LINK = {
    "serial_bit": "serial, cycles a bit",
    "serial_byte": "serial, bits a byte",
    "parallel_bits": "parallel, lines",
    "parallel_word": "parallel, cycles a word",
    "host_latency": "processor, cycles to a result",
}


@click.command("machine")
@click.argument("names", metavar="[NAME|FILE.yaml]...", nargs=-1, shell_complete=machines)
def command(names: tuple[str, ...]) -> None:
    """Show machines side by side: array, memories, cycles, sensor.

    Without a name: the machines that ship with npchip.

    \b
    Examples:
      npchip machine
      npchip machine default mine.yaml
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped
    from npchip.base.columns import aligned
    from npchip.isa import load_isa
    from npchip.machine import BUILTIN, Machine, load_machine

    classes = load_isa().timing_classes
    machines = [load_machine(name, classes) for name in names or BUILTIN]

    def row(title: str, *cells: object) -> tuple[str, ...]:
        return title, *map(str, cells)

    def each(title: str, attribute: str) -> tuple[str, ...]:
        return row(title, *(getattr(machine, attribute) for machine in machines))

    def size(machine: Machine) -> str:
        return f"{machine.np_rows} x {machine.np_cols}"

    rows = [
        each("", "name"),
        row("NPs", *map(size, machines)),
        row("pixels", *(f"{machine.rows} x {machine.cols}" for machine in machines)),
        each("program words", "rom_words"),
        each("memory of an NP, bytes", "memory_bytes"),
        each("return stack", "stack_depth"),
        each("open masked regions", "mask_depth"),
        *(
            row(f"cycles: {name}", *(machine.cycles(name) for machine in machines))
            for name in classes
        ),
        row("sensor: fixed pattern, LSB", *(m.sensor.fixed_pattern for m in machines)),
        row("sensor: noise, LSB rms", *(f"{m.sensor.noise_rms:g}" for m in machines)),
        row("sensor: seed", *(machine.sensor.seed for machine in machines)),
        *(
            row(f"link: {title}", *(getattr(machine.link, name) for machine in machines))
            for name, title in _LINK.items()
        ),
    ]
    text = "".join(f"{line}\n" for line in aligned(rows))
    summaries = "".join(f"{machine.name}: {machine.summary}\n" for machine in machines)
    emit(f"{text}\n{summaries}")
