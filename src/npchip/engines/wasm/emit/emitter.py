"""Code of basic blocks.

Every variable has a home: a local if it is uniform, its plane in memory if it varies, and none if
it is a known number. Homes keep the values from the beginning of a block until its last vector
loop has read them. Uniform variables move to their new homes on the edge to the next block, all
at once. Varying ones live in memory, as locals would need dozens of vector registers throughout
the program, and as most of the state is then in place when the module returns to the host.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.effects import Effects
from npchip.engines.wasm.emit.encode import I32, Function
from npchip.engines.wasm.emit.helpers import HELPERS, RECEIVE, REFILL, TICK
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.emit.vectors import Vectors
from npchip.engines.wasm.translate.analysis import Analysis
from npchip.engines.wasm.translate.counters import Counters
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.summary import ANY, SAME, is_bit
from npchip.engines.wasm.translate.values import NUMBERS, UNIFORM, VARYING, Value


class Emitter:
    """Writes the blocks of one program.

    Args:
        out: the function ``run``.
        layout: addresses in the module's memory.
        analysis: facts about the variables.
        live: bits of the variables that are live at the beginning of each block.
        headers: blocks that check the cycle limit.
        counters: numbers of the execution and profile counters.
        stops: whether the state is complete where the module asks about the cycle limit.

    Attributes:
        called: numbers of the helper functions that are called.
        sites: output instructions with their plane counts, by their number in the log.
    """

    def __init__(
        self,
        out: Function,
        layout: Layout,
        analysis: Analysis,
        *,
        live: Sequence[int],
        headers: frozenset[int],
        counters: Counters,
        stops: bool,
    ) -> None:
        self._out = out
        self._layout = layout
        self._analysis = analysis
        self._live = live
        self._headers = headers
        self._counters = counters
        self._stops = stops
        self._homes: dict[int, int] = {}
        self._vectors = Vectors(out, layout, self._home)
        self._effects = Effects(out, layout, self._vectors)
        self.called, self.sites = self._effects.called, self._effects.sites

    def _home(self, variable: int) -> int:
        """Return the local of a uniform variable."""
        found = self._homes.get(variable)
        if found is None:
            found = self._homes[variable] = self._out.local(I32)
        return found

    # ---- the state and the host

    def begin(self) -> bytes:
        """Return the code that loads the uniform variables of all blocks from the state."""
        out = Function()
        for variable, home in self._homes.items():
            out.write(f"i32.const 0 i32.load8_u {self._layout.variable(variable)}")
            if is_bit(variable):
                out.write("i32.const 1 i32.and")
            out.set(home)
        return bytes(out.code)

    def _spill(self, block: Block) -> None:
        """Store a byte of each variable that is uniform at the beginning of a block.

        The helper `complete` expands it to a plane.
        """
        out = self._out
        for variable, what in self._analysis.begins[block.number].items():
            if what != SAME:
                continue
            home = f"local.get {self._home(variable)}"
            value = f"i32.const 0 {home} i32.sub" if is_bit(variable) else home
            out.write(f"i32.const 0 {value} i32.store8 {self._layout.variable(variable)}")

    def _exit(self, block: Block) -> None:
        """Return to the host before a block. Its variables must be spilled, but to give up."""
        self._out.i32(block.number)
        self._out.op("return")

    # ---- blocks

    def body(self, block: Block) -> None:
        """Write the code of a block. If it branches, leave its condition on the stack."""
        self._body(block)
        self._vectors.loop.write()

    def _body(self, block: Block) -> None:
        out = self._out
        self._vectors.free()
        if block.number in self._headers:
            self._check_cycles(block)
        if block.leaves:
            self._spill(block)
            self._exit(block)
            return
        if block.exposes:
            self._expose(block)
        if block.port is not None:
            self._receive(block)
        done = self._analysis.summaries[block.number]
        assert done is not None
        self._effects.make_room(done.sends())
        self._count(block)
        needed = 0
        for after in block.after:
            needed |= self._live[after]
        outs = {v: value for v, value in done.outs.items() if needed >> v & 1}
        vectors = self._vectors
        vectors.begin(block.bounds, done.needs(), outs.values())
        self._effects.write(done.items, self._counters.masks + 2 * block.number)
        vectors.compute_crossings(*done.guards.values())
        vectors.finish(outs, done.wire)
        self._effects.commit_sends()
        self._count_guarded(block, done.guards)
        if done.wire is not None:
            vectors.scalar(done.wire)
        elif len(block.after) == 2:
            out.i32(1)
        if self._counters.profile and len(block.after) == 2:
            wire = vectors.temporary(I32)
            out.tee(wire)
            self._effects.count_wire(self._counters.branches + block.number, wire)

    def edge(self, block: Block, after: int) -> None:
        """Write the code of the edge to a successor.

        It moves the uniform variables to their new homes, all at once. Varying ones have been
        stored already.
        """
        live = self._live[after]
        done = self._analysis.summaries[block.number]
        assert done is not None
        homes: list[int] = []
        now, then = self._analysis.begins[block.number], self._analysis.begins[after]
        # With the same facts before and after, only the variables that the block writes move.
        for variable in done.outs.keys() & then.keys() if now == then else then:
            what = then[variable]
            if what < SAME or not live >> variable & 1:
                continue
            value = done.outs.get(variable)
            if value is None:
                if now[variable] == what:  # already in its home
                    continue
                value = self._leaf(block, variable)
            if value.kind == VARYING:
                continue
            if what == ANY:
                self._store(value, variable)
            elif value.op != "leaf" or value.number != variable:
                self._vectors.scalar(value)
                homes.append(self._home(variable))
        self._vectors.flush()
        self._vectors.loop.write()
        for home in reversed(homes):
            self._out.set(home)

    def _leaf(self, block: Block, variable: int) -> Value:
        """Return the value of a variable at the beginning of a block."""
        what = self._analysis.begins[block.number][variable]
        if what < SAME:
            return NUMBERS[what]
        return Value("leaf", (), variable, what - SAME + 1)

    def _store(self, value: Value, variable: int) -> None:
        """Store a constant or uniform value to the plane of a variable."""
        loop = self._vectors.loop
        loop.base()
        if value.kind == UNIFORM:  # not kept: other edges do not execute this code
            loop.use_local("get", self._vectors.splat(value, keep=False))
        else:
            self._vectors.vector(value, bit=is_bit(variable))
        loop.memory("v128.store", self._layout.variable(variable))

    def _check_cycles(self, block: Block) -> None:
        """Ask the host whether to go on if the frame has reached its next check."""
        out = self._out
        out.write(f"i32.const 0 i64.load {at.CYCLES} i32.const 0 i64.load {at.CHECK} i64.ge_s if")
        if self._stops:
            self._spill(block)
        self._effects.ask_host(TICK, block.number)
        out.op("if")
        self._exit(block)
        out.op("end", "end")

    def _expose(self, block: Block) -> None:
        """Close the frame, and take the next one from the ring buffer, which the host refills."""
        out = self._out
        if block.number not in self._headers:
            self._check_cycles(block)
        self._effects.call(HELPERS.close)
        words = f"i32.const 0 i32.load {at.POSITION} i32.const 0 i32.load {at.AVAILABLE}"
        out.write(f"{words} i32.ge_u if")
        self._spill(block)
        self._effects.ask_host(REFILL, block.number)
        out.op("i32.eqz", "if")
        self._exit(block)
        out.op("end", "end")
        self._effects.call(HELPERS.expose)

    def _receive(self, block: Block) -> None:
        """Get a plane from the partner, or return to the host if there is none."""
        out = self._out
        self._effects.ask_host(RECEIVE, block.number)
        out.op("i32.eqz", "if")
        self._spill(block)
        self._exit(block)
        out.op("end")

    def _count(self, block: Block) -> None:
        """Count an execution of the block, and its unguarded instructions and their cycles."""
        out = self._out
        steps = [
            step for _, step, counter in self._counters.steps(block) if counter == block.number
        ]
        self._add_time(steps, out.i64)
        self._effects.increase(block.number, lambda: out.i64(1))

    def _count_guarded(self, block: Block, guards: Mapping[int, Value]) -> None:
        """Count the guarded instructions and their cycles."""
        for index, wire in guards.items():
            self._vectors.materialize(wire)
            steps = block.steps[index + 1 : index + 1 + block.steps[index].guards]

            def push(number: int, wire: Value = wire) -> None:
                self._out.i64(number)
                self._out.i64(0)
                self._vectors.scalar(wire)
                self._out.op("select")

            self._add_time(steps, push)
            counter = self._counters.guards[block.number][index]
            self._effects.increase(counter, partial(push, 1))

    def _add_time(self, steps: Sequence[Step], push: Callable[[int], None]) -> None:
        """Count the cycles and instructions of steps. `push` pushes a number, or 0 to skip it."""
        cycles = sum(step.cycles for step in steps)
        for word, more in ((at.CYCLES, cycles), (at.INSTRUCTIONS, len(steps))):
            self._out.increase_long(word, partial(push, more))
