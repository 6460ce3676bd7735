"""Code of a block's effects: loads, stores, conversions, sends and counts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.encode import I32, Function
from npchip.engines.wasm.emit.helpers import DRAIN, HELPERS
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.emit.vectors import Vectors
from npchip.engines.wasm.translate.summary import Item, Site
from npchip.engines.wasm.translate.values import VARYING, Value


class Effects:
    """Writes the items of a block in program order.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
        vectors: writes values.

    Attributes:
        called: numbers of the helper functions that are called.
        sites: numbers in the log of output instructions with their plane counts: 0 for a uniform
            byte of all NPs, 1 for a plane of bytes, 2 for a plane of bytes and one of active NPs.
    """

    def __init__(self, out: Function, layout: Layout, vectors: Vectors) -> None:
        self._out = out
        self._layout = layout
        self._vectors = vectors
        self._loop = vectors.loop
        self._log = out.local(I32)  # address of the next log entry; see `make_room`
        self._data = out.local(I32)
        self._masks = 0  # the block's first counter of active NPs
        self._masked: dict[Value, Value] = {}  # masks of the items that need a value
        self._logged = 0  # sends, and below their planes, that the pointers do not include yet
        self._sent = 0
        self.called: set[int] = set()
        self.sites: dict[tuple[Site, int], int] = {}

    def call(self, function: int) -> None:
        """Call a helper function."""
        self.called.add(function)
        self._out.call(function)

    def ask_host(self, what: int, about: int = 0) -> None:
        """Ask the host and leave its answer on the stack."""
        self._out.write(f"i32.const {what} i32.const {about}")
        self._out.call(HELPERS.ask)

    def write(self, items: Sequence[Item], masks: int) -> None:
        """Write the items of a block. The last vector loop stays open.

        Args:
            items: the items.
            masks: the block's first counter of active NPs.
        """
        self._masks = masks
        self._masked = {v: item.mask for item in items if item.mask for v in item.values}
        actions: dict[str, Callable[[Item], None]] = {
            "load": self._load,
            "compute": self._compute,
            "store": self._store,
            "send": self._send,
            "sample": self._sample,
            "count": self._count,
        }
        for item in items:
            if item.kind in {"load", "compute"}:
                if item.values[0].uses:
                    actions[item.kind](item)
                continue
            self._vectors.compute_crossings(*item.operands())
            actions[item.kind](item)

    def _compute(self, item: Item) -> None:
        """Compute a value now, to keep register pressure low.

        Nothing reads the stored value, but Cranelift would sink the computation without the store.
        """
        self._vectors.materialize(item.values[0])
        if item.values[0].kind == VARYING:
            self._to_scratch(item.values[0], self._layout.anchor)

    # ---- the NPs' memory

    def _load(self, item: Item) -> None:
        (value,) = item.values
        (address,) = value.args
        if address.kind != VARYING:
            self._vectors.materialize(value)
            return
        self._vectors.compute_crossings(address)
        where = self._needed_where(value)
        if where is not None:
            self._vectors.materialize(where)
            self._to_scratch(where, self._layout.mask)
        self._to_scratch(address, self._layout.addresses)
        self._vectors.flush()
        self.call(HELPERS.gather if where is None else HELPERS.gather_some)
        self._loop.base()
        self._loop.memory("v128.load", self._layout.operand)
        self._vectors.bind(value)

    def _needed_where(self, load: Value) -> Value | None:
        """Return a value, made before a load, that is 0 in NPs that do not need the load."""
        value = load
        while value.uses == 1:
            where, user = self._masked.get(value), self._vectors.users.get(value)
            if user is not None and user.op in {"and", "both"}:
                where = user.args[user.args[0] is value]
            elif user is not None and user.op == "select" and user.args[1] is value:
                where = user.args[0]
            if where is not None and where.kind == VARYING and where.order < load.order:
                return where
            if user is None or user.op in {"any", "neighbour"}:
                return None
            value = user
        return None

    def _store(self, item: Item) -> None:
        loop, (address, value), mask = self._loop, item.values, item.mask
        if address.kind == VARYING:
            self._to_scratch(address, self._layout.addresses)
            self._to_scratch(value, self._layout.operand)
            if mask is not None:
                self._to_scratch(mask, self._layout.mask, bit=True)
            self._vectors.flush()
            self.call(HELPERS.scatter if mask is None else HELPERS.scatter_some)
            return
        offset = self._vectors.address(address)
        self._vectors.vector(value)
        if mask is not None:
            self._vectors.address(address)
            loop.memory("v128.load", offset)
            self._vectors.vector(mask, bit=True)
            loop.op("v128.bitselect")
        loop.memory("v128.store", offset)

    def _to_scratch(self, value: Value, plane: int, *, bit: bool = False) -> None:
        self._loop.base()
        self._vectors.vector(value, bit=bit)
        self._loop.memory("v128.store", plane)

    # ---- devices

    def _send(self, item: Item) -> None:
        out, loop, (value,), mask = self._out, self._loop, item.values, item.mask
        planes = item.planes
        assert item.site is not None
        number = self.sites.setdefault((item.site, planes), len(self.sites))
        stride = self._layout.stride
        out.get(self._log)
        out.i32(number << 8)
        if not planes:
            self._vectors.scalar(value)
            out.op("i32.or")
        out.memory("i32.store", at.ENTRY * self._logged)
        self._logged += 1
        if planes:
            loop.base(self._data)
            self._vectors.vector(value)
            if mask is not None:
                self._vectors.vector(mask, bit=True)
                loop.op("v128.and")
            loop.memory("v128.store", stride * self._sent)
            if mask is not None:
                loop.base(self._data)
                self._vectors.vector(mask, bit=True)
                loop.memory("v128.store", stride * (self._sent + 1))
            self._sent += planes

    def commit_sends(self) -> None:
        """Move the log's end past the latest sends. No vector loop may be open."""
        if self._logged:
            self._move(self._log, at.LOG_END, at.ENTRY * self._logged)
        if self._sent:
            self._move(self._data, at.DATA_END, self._layout.stride * self._sent)
        self._logged = self._sent = 0

    def _move(self, pointer: int, word: int, count: int) -> None:
        self._out.write(f"""
            i32.const 0 local.get {pointer} i32.const {count} i32.add local.tee {pointer}
            i32.store {word}
        """)

    def make_room(self, sends: Sequence[Item]) -> None:
        """Let the host drain the log if a block's sends might not fit."""
        if not sends:
            return
        out, where = self._out, self._layout
        planes = sum(item.planes for item in sends)
        pointers = [(self._log, at.LOG_END)]
        if planes:
            pointers.append((self._data, at.DATA_END))
        self._load_pointers(pointers)
        last = where.log_end - at.ENTRY * len(sends)
        out.write(f"local.get {self._log} i32.const {last} i32.gt_u")
        if planes:
            last = where.data_end - where.stride * planes
            out.write(f"local.get {self._data} i32.const {last} i32.gt_u i32.or")
        out.op("if")
        self.ask_host(DRAIN)
        out.op("drop")
        self._load_pointers(pointers)
        out.op("end")

    def _load_pointers(self, pointers: Sequence[tuple[int, int]]) -> None:
        for local, word in pointers:
            self._out.write(f"i32.const 0 i32.load {word} local.set {local}")

    def _sample(self, item: Item) -> None:
        """Convert all pixels into a bank, through a buffer if there is a mask."""
        out, where = self._out, self._layout
        if item.needless:
            self._out.increase(at.CONVERSIONS, 1)
            return
        self._vectors.flush()
        bank = where.memory + item.bank * where.stride
        target = bank if item.mask is None else where.converted
        sensor, size = where.machine.sensor, at.PLANES * where.stride
        out.i32(target)
        if item.signal:
            out.write(f"i32.const 0 i32.load {at.FRAME}")
            self.call(HELPERS.signal)
        elif sensor.fixed_pattern and not sensor.noise_rms:
            out.write(f"i32.const {where.offsets} i32.const {size} memory.copy")
        else:
            out.write(f"i32.const 0 i32.const {size} memory.fill")
        if sensor.noise_rms:
            out.i32(target)
            self.call(HELPERS.noise)
        if item.mask is not None:
            self._to_scratch(item.mask, where.mask, bit=True)
            self._vectors.flush()
            out.i32(bank)
            self.call(HELPERS.merge)
        out.increase(at.CONVERSIONS, 1)

    # ---- counters

    def increase(self, counter: int, push: Callable[[], None]) -> None:
        """Add to a counter the 64-bit number that `push` leaves on the stack."""
        self._out.increase_long(self._layout.counts + 8 * counter, push)

    def count_wire(self, counter: int, wire: int) -> None:
        """Add 1 to a counter if the wire in a local is set."""
        self.increase(counter, lambda: self._out.write(f"local.get {wire} i64.extend_i32_u"))

    def _count(self, item: Item) -> None:
        """Add the number of active NPs of a mask to its counter."""
        self._to_scratch(item.values[0], self._layout.mask, bit=True)
        self._vectors.flush()
        self.increase(self._masks + item.number, lambda: self.call(HELPERS.active))
