"""The code of blocks: values to WebAssembly.

Every variable has a home in locals: one ``i32`` where it is uniform, one ``v128`` for each 16 NPs
where it varies, none where it is a known number. Homes change only on the way from block to
block, all at once; within a block they hold what the block began with.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from npchip.engines.wasm import layout as at
from npchip.engines.wasm.analysis import Analysed
from npchip.engines.wasm.block import ANY, SAME, Item, Site, is_bit, variables
from npchip.engines.wasm.encode import I32, I64, V128, Function
from npchip.engines.wasm.graph import Block, Place
from npchip.engines.wasm.layout import Layout
from npchip.engines.wasm.runtime import HELPERS
from npchip.engines.wasm.structure import Emit
from npchip.engines.wasm.values import CONSTANT, UNIFORM, VARYING, Node
from npchip.engines.wasm.vectors import Vectors

OUT_OF_CYCLES: Final = -1
"""What ``run`` returns where a frame has reached its limit; else the number of an exit."""


class Emitter(Emit):
    """Writes the blocks of one program.

    Args:
        out: the function ``run``.
        layout: where things lie.
        analysed: what is known.
        headers: blocks at which the cycles are checked.
        exact: whether the module hands its state back at a header where the host asks for it.
        probe: whether it tells the host its state before every block.

    Attributes:
        called: numbers of the functions that are called.
        exits: places at which the module hands its state back, by the number it returns.
        sites: by number of the log the output instruction and how many planes follow: none for a
            uniform byte of all NPs, the bytes, or the bytes and which NPs are active.
    """

    def __init__(
        self,
        out: Function,
        layout: Layout,
        analysed: Analysed,
        headers: frozenset[int],
        *,
        exact: bool,
        probe: bool,
    ) -> None:
        self._out = out
        self._layout = layout
        self._analysed = analysed
        self._headers = headers
        self._exact = exact
        self._probe = probe
        self.called: set[int] = set()
        self.exits: list[Place] = []
        self._sites: dict[tuple[Site, int], int] = {}
        self._homes: dict[tuple[int, int], int] = {}
        self._vectors = Vectors(out, layout, self._home)
        self._position = out.local(I32)
        self._log = out.local(I32)
        self._data = out.local(I32)
        self._conversions = out.local(I32)
        self._frame = out.local(I32)
        self._cycles = out.local(I64)
        self._instructions = out.local(I64)
        self._check = out.local(I64)

    @property
    def sites(self) -> list[tuple[Site, int]]:
        """See the class."""
        return list(self._sites)

    def _home(self, variable: int, kind: int) -> int:
        """First local of a variable's home."""
        key = (variable, kind)
        found = self._homes.get(key)
        if found is None:
            varying = kind == VARYING
            count = self._layout.vectors if varying else 1
            found = self._homes[key] = self._out.local(V128 if varying else I32, count)
        return found

    # ---- the GCU's state

    def _words(self) -> list[tuple[int, int, str]]:
        """Control words, their locals and types."""
        return [
            (self._position, at.POSITION, "i32"),
            (self._log, at.LOG_END, "i32"),
            (self._data, at.DATA_END, "i32"),
            (self._conversions, at.CONVERSIONS, "i32"),
            (self._frame, at.FRAME, "i32"),
            (self._cycles, at.CYCLES, "i64"),
            (self._instructions, at.INSTRUCTIONS, "i64"),
            (self._check, at.CHECK, "i64"),
        ]

    def begin(self) -> None:
        """Take the state over from the host."""
        out = self._out
        for local, word, kind in self._words():
            out.i32(0)
            out.memory(f"{kind}.load", word)
            out.set(local)
        for variable, what in self._analysed.begins[0].items():
            if what < SAME:
                continue
            address = self._layout.variable(variable)
            for index in range(self._layout.vectors if what == ANY else 1):
                out.i32(0)
                if what == ANY:
                    out.memory("v128.load", address + at.VECTOR * index)
                else:
                    out.memory("i32.load8_u", address)
                    if is_bit(variable):
                        out.i32(1)
                        out.op("i32.and")
                out.set(self._home(variable, what - SAME + 1) + index)

    def _tell_words(self) -> None:
        for local, word, kind in self._words():
            self._out.i32(0)
            self._out.get(local)
            self._out.memory(f"{kind}.store", word)

    def _tell_variables(self, block: Block) -> None:
        """Hand over all variables as they are when a block begins."""
        begin = self._analysed.begins[block.number]
        for variable in variables(block.first.place.depth):
            for index in range(self._layout.vectors):
                self._out.i32(0)
                self._push_home(variable, begin[variable], index)
                self._out.memory("v128.store", self._layout.variable(variable) + at.VECTOR * index)

    def _exit(self, block: Block) -> None:
        """Hand the state back before a block; `_tell_words` and `_tell_variables` are done."""
        self._out.i32(len(self.exits))
        self._out.op("return")
        self.exits.append(block.first.place)

    def _call(self, function: int) -> None:
        self.called.add(function)
        self._out.call(function)

    # ---- blocks

    def body(self, block: Block) -> None:
        """See `Emit.body`."""
        out = self._out
        if block.number in self._headers:
            self._check_cycles(block)
        if self._probe:
            self._tell_words()
            self._tell_variables(block)
            out.i32(block.number)
            self._call(HELPERS.probe)
        if block.leaves:
            self._tell_words()
            self._tell_variables(block)
            self._exit(block)
            return
        if block.exposes:
            self._expose(block)
        self._count(block)
        done = self._analysed.executed[block.number]
        assert done is not None
        needed = 0
        for after in block.after:
            needed |= self._analysed.live[after]
        outs = [node for variable, node in done.outs.items() if needed >> variable & 1]
        self._vectors.begin(done.items, outs, done.wire)
        for item in done.items:
            self._item(item)
        for node in outs:
            self._vectors.hold(node)
        if done.wire is not None:
            self._vectors.scalar(done.wire)
        elif len(block.after) == 2:
            out.i32(1)

    def edge(self, block: Block, after: int) -> None:
        """See `Emit.edge`: variables move to their homes in the following block, all at once."""
        begin, following = self._analysed.begins[block.number], self._analysed.begins[after]
        live = self._analysed.live[after]
        done = self._analysed.executed[block.number]
        assert done is not None
        targets: list[int] = []
        for variable, what in following.items():
            if what < SAME or not live >> variable & 1:
                continue
            node = done.outs.get(variable)
            if node is None and begin[variable] == what:
                continue
            if (
                node is not None
                and node.op == "leaf"
                and (node.value, node.kind)
                == (
                    variable,
                    what - SAME + 1,
                )
            ):
                continue
            for index in range(self._layout.vectors if what == ANY else 1):
                if node is None:
                    if what == ANY:
                        self._push_home(variable, begin[variable], index)
                    else:
                        self._out.i32(begin[variable])
                elif what == ANY:
                    self._vectors.held_lanes(node, index, bit=is_bit(variable))
                else:
                    self._vectors.scalar(node)
                targets.append(self._home(variable, what - SAME + 1) + index)
        for target in reversed(targets):
            self._out.set(target)

    def _push_home(self, variable: int, what: int, index: int) -> None:
        """Vector `index` of what a variable's home holds."""
        if what == ANY:
            self._out.get(self._home(variable, VARYING) + index)
        elif what == SAME:
            self._out.get(self._home(variable, UNIFORM))
            self._vectors.splat(bit=is_bit(variable))
        else:
            number = 255 * what if is_bit(variable) else what
            self._out.v128(bytes([number]) * at.VECTOR)

    def _check_cycles(self, block: Block) -> None:
        """Ask the host whether a frame that has taken long may go on."""
        out = self._out
        out.get(self._cycles)
        out.get(self._check)
        out.op("i64.ge_s")
        out.if_()
        self._tell_words()
        self._call(HELPERS.tick)
        out.tee(self._check)
        out.i64(0)
        out.op("i64.lt_s")
        out.if_()
        if self._exact:
            self._tell_variables(block)
            self._exit(block)
        else:
            out.i32(OUT_OF_CYCLES)
            out.op("return")
        out.op("end", "end")

    def _expose(self, block: Block) -> None:
        """Close the frame and take the next one; where the ring is empty the host refills it."""
        out = self._out
        if block.number not in self._headers:
            self._check_cycles(block)
        out.get(self._position)
        out.i32(0)
        out.memory("i32.load", at.AVAILABLE)
        out.op("i32.ge_u")
        out.if_()
        self._tell_words()
        self._tell_variables(block)
        out.i32(len(self.exits))
        self._call(HELPERS.refill)
        out.op("i32.eqz")
        out.if_()
        self._exit(block)
        out.op("end")
        for local, word in (
            (self._position, at.POSITION),
            (self._log, at.LOG_END),
            (self._data, at.DATA_END),
        ):
            out.i32(0)
            out.memory("i32.load", word)
            out.set(local)
        out.op("else")
        record = [(self._cycles, "i64", 0), (self._instructions, "i64", 8), (self._log, "i32", 16)]
        for local, kind, offset in record:
            out.get(self._position)
            out.i32(at.RECORD)
            out.op("i32.mul")
            out.get(local)
            out.memory(f"{kind}.store", self._layout.records - at.RECORD + offset)
        out.op("end")
        out.get(self._position)
        out.i32(self._layout.frame_bytes)
        out.op("i32.mul")
        out.i32(self._layout.frames)
        out.op("i32.add")
        out.set(self._frame)
        out.get(self._position)
        out.i32(1)
        out.op("i32.add")
        out.set(self._position)
        out.i32(0)
        out.set(self._conversions)
        for local in (self._cycles, self._instructions):
            out.i64(0)
            out.set(local)

    def _count(self, block: Block) -> None:
        """Count the block, its instructions and its cycles."""
        out = self._out
        cycles = sum(step.cycles for step in block.steps)
        for local, more in ((self._cycles, cycles), (self._instructions, len(block.steps))):
            out.get(local)
            out.i64(more)
            out.op("i64.add")
            out.set(local)
        place = self._layout.counts + 8 * block.number
        out.i32(0)
        out.i32(0)
        out.memory("i64.load", place)
        out.i64(1)
        out.op("i64.add")
        out.memory("i64.store", place)

    # ---- items

    def _item(self, item: Item) -> None:
        guarded = item.guard is not None
        if guarded:
            for node in item.operands():
                self._vectors.hold(node, splat=True)  # here, not only where the wire is set
            assert item.guard is not None
            self._vectors.scalar(item.guard)
            self._out.if_()
        actions: dict[str, Callable[[Item], None]] = {
            "load": self._load,
            "store": self._store,
            "send": self._send,
            "sample": self._sample,
            "keep": lambda item: self._vectors.keep(item.nodes[0]),
        }
        actions[item.kind](item)
        if guarded:
            self._out.op("end")

    def _load(self, item: Item) -> None:
        node = item.nodes[0]
        if not node.uses:
            return
        (address,) = node.args
        if address.kind == VARYING:
            self._to_scratch(address, self._layout.addresses)
            self._call(HELPERS.gather)
            self._vectors.take(node, lambda index: self._from(self._layout.operand, index))
            return
        base, offset = self._plane(address)

        def push(index: int) -> None:
            self._push_base(base)
            self._out.memory("v128.load", offset + at.VECTOR * index)

        self._vectors.take(node, push)

    def _store(self, item: Item) -> None:
        out, (address, value), mask = self._out, item.nodes, item.mask
        if address.kind == VARYING:
            self._to_scratch(address, self._layout.addresses)
            self._to_scratch(value, self._layout.operand)
            self._mask_to_scratch(mask)
            self._call(HELPERS.scatter)
            return
        base, offset = self._plane(address)
        for index in range(self._layout.vectors):
            self._push_base(base)
            self._vectors.lanes(value, index)
            if mask is not None:
                self._push_base(base)
                out.memory("v128.load", offset + at.VECTOR * index)
                self._vectors.lanes(mask, index, bit=True)
                out.op("v128.bitselect")
            out.memory("v128.store", offset + at.VECTOR * index)

    def _plane(self, address: Node) -> tuple[int, int]:
        """Local with the first byte's address of a plane (-1 for 0), and an offset to add."""
        if address.kind == CONSTANT:
            return -1, self._layout.memory + address.value * self._layout.stride
        base = self._vectors.temporary(I32)
        self._vectors.scalar(address)
        self._out.i32(self._layout.stride)
        self._out.op("i32.mul")
        self._out.set(base)
        return base, self._layout.memory

    def _push_base(self, base: int) -> None:
        if base < 0:
            self._out.i32(0)
        else:
            self._out.get(base)

    def _from(self, plane: int, index: int) -> None:
        self._out.i32(0)
        self._out.memory("v128.load", plane + at.VECTOR * index)

    def _to_scratch(self, node: Node, plane: int, *, bit: bool = False) -> None:
        for index in range(self._layout.vectors):
            self._out.i32(0)
            self._vectors.lanes(node, index, bit=bit)
            self._out.memory("v128.store", plane + at.VECTOR * index)

    def _mask_to_scratch(self, mask: Node | None) -> None:
        if mask is not None:
            self._to_scratch(mask, self._layout.mask, bit=True)
            return
        for index in range(self._layout.vectors):
            self._out.i32(0)
            self._out.v128(b"\xff" * at.VECTOR)
            self._out.memory("v128.store", self._layout.mask + at.VECTOR * index)

    def _send(self, item: Item) -> None:
        out, (value,), mask = self._out, item.nodes, item.mask
        planes = 2 if mask is not None else int(value.kind == VARYING)
        assert item.site is not None
        number = self._sites.setdefault((item.site, planes), len(self._sites))
        out.get(self._log)
        out.i32(number << 8)
        if not planes:
            self._vectors.scalar(value)
            out.op("i32.or")
        out.memory("i32.store", 0)
        self._advance(self._log, at.ENTRY)
        if planes:
            for index in range(self._layout.vectors):
                out.get(self._data)
                self._vectors.lanes(value, index)
                if mask is not None:
                    self._vectors.lanes(mask, index, bit=True)
                    out.op("v128.and")
                out.memory("v128.store", at.VECTOR * index)
                if mask is not None:
                    out.get(self._data)
                    self._vectors.lanes(mask, index, bit=True)
                    out.memory("v128.store", self._layout.stride + at.VECTOR * index)
            self._advance(self._data, planes * self._layout.stride)
        self._drain(planes)

    def _advance(self, local: int, count: int) -> None:
        self._out.get(local)
        self._out.i32(count)
        self._out.op("i32.add")
        self._out.set(local)

    def _drain(self, planes: int) -> None:
        """Let the host take the sends where there is no room for more."""
        out = self._out
        out.get(self._log)
        out.i32(self._layout.log_limit)
        out.op("i32.ge_u")
        if planes:
            out.get(self._data)
            out.i32(self._layout.data_limit)
            out.op("i32.ge_u", "i32.or")
        out.if_()
        self._tell_words()
        self._call(HELPERS.drain)
        for local, start in ((self._log, self._layout.log), (self._data, self._layout.data)):
            out.i32(start)
            out.set(local)
        out.op("end")

    def _sample(self, item: Item) -> None:
        """Convert all pixels into a bank; under a mask by way of a buffer."""
        out, where = self._out, self._layout
        bank = where.memory + item.bank * where.stride
        target = bank if item.mask is None else where.converted
        signal = item.signal
        if where.machine.sensor.noise_rms > 0:  # the host's sensor knows the numbers
            self._tell_words()
            out.i32(int(signal))
            self._call(HELPERS.convert)
            if item.mask is None:
                out.i32(bank)
                out.i32(where.converted)
                out.i32(at.PLANES * where.stride)
                out.copy()
        elif signal:
            out.i32(target)
            out.get(self._frame)
            self._call(HELPERS.signal)
        else:
            out.i32(target)
            out.i32(where.offsets)
            out.i32(at.PLANES * where.stride)
            out.copy()
        if item.mask is not None:
            self._mask_to_scratch(item.mask)
            out.i32(bank)
            self._call(HELPERS.merge)
        self._advance(self._conversions, 1)
