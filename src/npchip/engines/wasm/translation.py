"""Translates a program to a WebAssembly module: runs the passes in order."""

from __future__ import annotations

import gc
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final, Literal

from npchip.engines.wasm.emit import structure
from npchip.engines.wasm.emit.constants import constants
from npchip.engines.wasm.emit.emitter import Emitter
from npchip.engines.wasm.emit.encode import I32, Function, module
from npchip.engines.wasm.emit.helpers import HELPERS, HOST, functions
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.translate.analysis import liveness, uniformity, use_zeros
from npchip.engines.wasm.translate.block import Executor
from npchip.engines.wasm.translate.counters import CounterRows, Counters, counter_rows, plan
from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.if_conversion import convert
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import Facts, Site
from npchip.engines.wasm.translate.unroll import unroll
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Place
from npchip.program.model import OutputKind, Program

Stops = Literal["never", "block", "step"]
"""Stops of a module at its host's request: none, or before every block or step, which is slower."""
_LONGEST: Final = 160
"""Most steps of a block. Longer blocks give faster code, but Cranelift's time grows faster."""


@dataclass(eq=False)
class Translation:
    """A program as a WebAssembly module.

    Attributes:
        binary: the module.
        layout: addresses in its memory.
        stops: where the module can return to its host.
        blocks: basic blocks of the program.
        begins: facts about the variables before each block.
        sites: output instructions by number, each with the number of planes of its sends.
        kinds: kind of each declared output, by port.
        counters: numbers of the execution and profile counters.
        rows: terms that the counters add to the tables of a profile; None without one.
    """

    binary: bytes
    layout: Layout
    stops: Stops
    blocks: Sequence[Block]
    begins: Sequence[Facts]
    sites: Sequence[tuple[Site, int]]
    kinds: Mapping[int, OutputKind]
    counters: Counters
    rows: CounterRows | None

    def holds(self, begin: Facts) -> bool:
        """Return whether a run may begin with other facts than those of the translation."""
        return all(begin[variable] <= fact for variable, fact in self.begins[0].items())


@contextmanager
def _uncollected() -> Iterator[None]:
    """Pause Python's garbage collector, as nearly all objects live until the end.

    This affects other threads too.
    """
    enabled = gc.isenabled()
    try:
        gc.disable()
        yield
    finally:
        if enabled:
            gc.enable()


@_uncollected()
def translate(
    program: Program,
    machine: Machine,
    isa: Isa,
    entry: Place,
    begin: Mapping[int, int],
    *,
    stops: Stops = "never",
    profile: bool = False,
    content: Sequence[tuple[int, bytes]] = (),
) -> Translation:
    """Translate a program.

    Args:
        program: the program.
        machine: the machine.
        isa: the instruction set.
        entry: place where execution begins.
        begin: facts about each variable there.
        stops: where the host may stop the module and see the complete state.
        profile: whether to count taken branches and active NPs too, which needs a stop before
            every step.
        content: what the module's memory holds at first, besides constants, with addresses.

    Raises:
        TooLargeError: see `graph.build`.
    """
    assert stops == "step" or not profile
    longest = 1 if stops == "step" else _LONGEST
    blocks = build(program, machine, isa, entry, longest)
    if stops != "step":
        blocks = convert(blocks, longest)
    blank = machine.sensor.noise_rms == 0 == machine.sensor.fixed_pattern
    executor = Executor(isa, machine.memory_bytes, blank=blank, profile=profile)
    analysis = uniformity(blocks, executor, begin)
    while stops != "step" and (fewer := unroll(blocks, analysis, longest)) is not None:
        known = {b.first.place: found for b, found in zip(blocks, analysis.begins, strict=True)}
        blocks = fewer
        analysis = uniformity(blocks, executor, begin, known)
    use_zeros(blocks, analysis, executor)
    everywhere = frozenset(range(len(blocks)))
    live = liveness(blocks, analysis, frozenset() if stops == "never" else everywhere)
    counters = plan(analysis.summaries, profile=profile)
    sends = max([len(done.sends()) for done in analysis.summaries if done is not None], default=0)
    kinds = {output.port: output.kind for output in program.outputs}
    assembles = "picture" in kinds.values()
    layout = Layout(machine, len(blocks), counters.count, sends, assembles)
    out = Function(parameters=(I32,), results=(I32,))
    emitter = Emitter(
        out,
        layout,
        analysis,
        live=live,
        headers=structure.headers(blocks) if stops == "never" else everywhere,
        counters=counters,
        stops=stops != "never",
    )
    structure.write(blocks, out, emitter)
    out.op("unreachable")
    out.code[:0] = emitter.begin()
    others = functions(layout, {*emitter.called, HELPERS.complete, *[HELPERS.assemble] * assembles})
    exported = {"complete": HELPERS.complete, "assemble": HELPERS.assemble, "run": 1 + len(others)}
    data = [*constants(layout, analysis.begins), *content]
    binary = module([HOST], [*others, out], exported, layout.pages, data)
    rows = counter_rows(blocks, counters, layout.lanes) if profile else None
    sites = list(emitter.sites)
    return Translation(binary, layout, stops, blocks, analysis.begins, sites, kinds, counters, rows)
