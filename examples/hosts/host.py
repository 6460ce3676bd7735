"""A host of modules that ``npchip asm -o PROGRAM.wasm`` wrote, for Python.

    python host.py PROGRAM.wasm CLIP.npy [--max-cycles N] [--partner PROGRAM.wasm CLIP.npy]
                                         [--state]

It runs a program on a clip, uint8 of shape (frames, rows, columns), and prints the result.
docs/module.md describes the modules, docs/json.md the JSON. It needs NumPy and wasmtime.
"""

from __future__ import annotations

import argparse
import io
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from wasmtime import Func, FuncType, Instance, Module, Store, ValType

Bytes: TypeAlias = NDArray[np.uint8]


class Send(NamedTuple):
    """What an ``OUT`` sent: a byte of each NP, and which NPs were active."""

    port: int
    address: int
    data: Bytes
    active: NDArray[np.bool_]


@dataclass
class Frame:
    """What a frame took, and the planes (or single bytes) of its outputs by port."""

    cycles: int
    instructions: int
    complete: bool = True
    parts: dict[int, list[Any]] = field(default_factory=dict)


class Saved(NamedTuple):
    """What a run had at a refill: frames, bytes of the module's memory, and the block."""

    frames: list[Frame]
    state: Bytes
    block: dict[str, Any]


class BrokenRuleError(Exception):
    """A complete frame has broken a rule of an output, and ends the run."""

    def __init__(self, code: str, send: Send) -> None:
        super().__init__(code)
        self.shown = {"code": code, "message": None, "address": send.address}


def sections(wasm: bytes) -> dict[str, bytes]:
    """Return the custom sections of a module by name."""

    def number(file: io.BytesIO) -> int:
        byte = file.read(1)[0]  # has seven bits of the number, the lowest first
        return byte if byte < 128 else byte - 128 + 128 * number(file)

    file, found = io.BytesIO(wasm[8:]), {}
    while kind := file.read(1):
        section = io.BytesIO(file.read(number(file)))
        if kind == b"\0":
            name = section.read(number(section)).decode()
            found[name] = section.read()
    return found


def parts_of(kind: str, sends: list[Send]) -> list[Any]:
    """Return the planes or bytes that make an output; raise BrokenRuleError if they do not."""
    if kind in ("scalar", "scalar16", "list"):
        sends = [send for send in sends if send.active.any()]
    if kind in ("scalar", "plane"):
        sends = sends[-1:]
    if sends and len(sends) != {"scalar16": 2, "picture": 64}.get(kind, len(sends)):
        raise BrokenRuleError("NP311", sends[-1])
    if kind in ("plane", "picture"):
        return [send.data for send in sends]
    for send in sends:
        if np.ptp(send.data[send.active]):
            raise BrokenRuleError("NP310", send)
    return [int(send.data[send.active][0]) for send in sends]


def value_of(kind: str, parts: list[Any], shape: tuple[int, int]) -> Any:
    """Return the value of an output as JSON has it."""
    if kind == "list" or not parts:
        return parts or None
    if kind in ("scalar", "scalar16"):
        return int.from_bytes(bytes(parts), "little")
    if kind == "plane":
        return parts[0].reshape(shape).tolist()
    pixels = np.reshape(parts, (8, 8, *shape)).transpose(2, 0, 3, 1)
    return pixels.reshape(8 * shape[0], 8 * shape[1]).tolist()


class Run:
    """A run of one form of a program, from the reset or from what was saved at a refill."""

    def __init__(
        self, wasm: bytes, clip: Bytes, limit: int, partner: list[Frame], saved: Saved | None = None
    ) -> None:
        self.about = about = json.loads(sections(wasm)["npchip"])
        self.clip, self.limit, self.partner, self.saved = clip, limit, partner, saved
        self.kinds = {output["port"]: output["kind"] for output in about["outputs"]}
        self.shape = about["np_rows"], about["np_cols"]
        self.size = about["np_rows"] * about["np_cols"]
        self.frames: list[Frame] = []  # the first is the setup
        self.sends: list[Send] = []  # of the present frame, as far as they were taken from the log
        self.heard: dict[tuple[int, int], int] = {}  # bytes received, by frame and port
        self.broken: BrokenRuleError | None = None
        requests = {"refill": self.refill, "tick": self.tick, "receive": self.receive}
        self.answers = {number: requests.get(name) for name, number in about["requests"].items()}
        store = Store()
        ask = Func(store, FuncType([ValType.i32()] * 2, [ValType.i32()]), self.ask)
        exports: Any = Instance(store, Module(store.engine, wasm), [ask]).exports(store)
        memory = exports["memory"]
        self.memory = np.ctypeslib.as_array(memory.data_ptr(store), (memory.data_len(store),))
        self.complete: Callable[[int], None] = partial(exports["complete"], store)
        first = 0
        if saved is not None:
            self.frames += saved.frames
            self.memory[: len(saved.state)] = saved.state
            first = about["blocks"].index(saved.block)
        self.put(frame=about["frames"]["first"], check=limit, first_check=limit)
        self.clear_log()
        self.last = exports["run"](store, first)
        self.take_frames()
        self.over = self.is_over(self.last)

    def word(self, name: str) -> NDArray[Any]:
        """Return a control word as an array of one number, which may be changed."""
        longs = self.about["longs"]
        if name in longs:
            return self.memory[longs[name] : longs[name] + 8].view("<u8")
        begin = self.about["words"][name]
        return self.memory[begin : begin + 4].view("<u4")

    def get(self, name: str) -> int:
        """Return the number in a control word."""
        return int(self.word(name)[0])

    def put(self, **numbers: int) -> None:
        """Write control words."""
        for name, number in numbers.items():
            self.word(name)[0] = number

    def planes(self, begin: int, number: int) -> Bytes:
        """Return planes, which lie one after the other, a row for each."""
        stride = self.about["stride"]
        planes = self.memory[begin : begin + number * stride].reshape(number, stride)
        return planes[:, : self.size].copy()

    def ask(self, request: int, block: int) -> int:
        """Do what the module asks for; a drain is the request without a method."""
        answer = self.answers[request]
        if answer is None:
            self.take_frames()
        return 0 if answer is None else int(answer(block))

    def is_over(self, block: int) -> bool:
        """Return whether the frame is over its limit; at just the limit an EXPOSE may come."""
        exposes = "exposes" in self.about["blocks"][block]
        return self.get("cycles") >= self.limit + exposes

    def tick(self, block: int) -> bool:
        """Answer whether to stop."""
        self.put(check=self.get("cycles") + 1)
        return self.is_over(block)

    def refill(self, block: int) -> bool:
        """Put frames into the ring. The stepping form gets one, to stop where a rule is broken."""
        self.take_frames()
        frames, taken = self.about["frames"], self.get("taken") + self.get("available")
        most = frames["capacity"] if self.about["form"] == "run" else 1
        new = self.clip[taken : taken + most]
        if self.broken or not len(new):
            return False
        self.complete(block)
        state = self.memory[: self.about["state_end"]].copy()
        self.saved = Saved(self.frames.copy(), state, self.about["blocks"][block])
        self.memory[frames["ring"] : frames["ring"] + new.size] = new.reshape(-1)
        self.put(taken=taken, position=0, available=len(new))
        return True

    def receive(self, block: int) -> bool:
        """Write what the partner sent in its frame of the same number, if it did."""
        key = self.get("taken") + self.get("position"), self.about["blocks"][block]["port"]
        frame, port = key  # 1 is the first frame, 0 the setup, which receives nothing
        parts = self.partner[frame].parts.get(port, []) if 0 < frame < len(self.partner) else []
        index = self.heard.get(key, 0)
        if index >= len(parts):
            return False
        self.heard[key] = index + 1
        begin = self.about["planes"]["received"]
        self.memory[begin : begin + self.size] = parts[index]
        return True

    def clear_log(self) -> None:
        """Let the module write records and sends from the beginning."""
        self.put(closed=0, log_end=self.about["log"], data_end=self.about["data"])

    def take_frames(self) -> None:
        """Take the complete frames, and what the present one has sent."""
        log, records = self.about["log"], self.about["records"]
        sends, begin = self.logged(), 0
        closed = self.memory[records : records + 24 * self.get("closed")].view("<u8,<u8,<u4,<u4")
        for cycles, instructions, log_end, _ in closed.tolist():
            end = (log_end - log) // 4
            self.sends += sends[begin:end]
            begin = end
            if instructions or not self.frames:  # a run that goes on at a block begins with others
                self.close(cycles, instructions)
        self.sends += sends[begin:]
        self.clear_log()

    def logged(self) -> list[Send]:
        """Return the sends in the log."""
        sends, data = [], self.about["data"]
        for entry in self.memory[self.about["log"] : self.get("log_end")].view("<u4").tolist():
            site = self.about["sites"][entry >> 8]
            planes = self.planes(data, site["planes"])
            data += len(planes) * self.about["stride"]
            sent = planes[0] if len(planes) else np.full(self.size, entry & 255, np.uint8)
            active = planes[1] != 0 if len(planes) == 2 else np.ones(self.size, np.bool_)
            sends.append(Send(site["port"], site["address"], sent, active))
        return sends

    def close(self, cycles: int, instructions: int, *, complete: bool = True) -> None:
        """Close the present frame."""
        frame = Frame(cycles, instructions, complete)
        try:
            for port in dict.fromkeys([*self.kinds, *[send.port for send in self.sends]]):
                sends = [send for send in self.sends if send.port == port]
                frame.parts[port] = parts_of(self.kinds.get(port, "plane"), sends)
        except BrokenRuleError as error:
            frame = Frame(cycles, instructions, complete=False)
            if complete:
                self.broken = error
        self.frames.append(frame)
        self.sends = []

    def finish(self) -> None:
        """Find out how the run ended, and close the frame in which it did."""
        block = self.about["blocks"][self.last]
        end = block.get("exit", {"status": "frames-exhausted"})
        if self.over:  # comes first: the limit is compared before each instruction
            end = {"status": "cycle-limit"}
        elif "port" in block:
            heard = self.heard.get((self.get("taken") + self.get("position"), block["port"]))
            often = f"more than {heard} bytes in this frame" if heard else "anything"
            message = f"no partner has sent {often} to port {block['port']}"
            end = {"status": "failed", "code": "NP306", "message": message}
        halted = end["status"] == "halted"  # its instruction is not counted yet
        if end["status"] != "frames-exhausted":
            cycles, instructions = self.get("cycles"), self.get("instructions")
            cycles += end.get("cycles", 0)
            self.close(cycles, instructions + halted, complete=halted)
        self.status, self.address = end["status"], block["address"] + halted
        self.error: dict[str, Any] | None = None
        if self.broken:
            self.status, self.error = "failed", self.broken.shown
        elif self.status == "failed":
            message = f"at address {self.address}: {end['message']}"
            self.error = {"code": end["code"], "message": message, "address": self.address}

    # ---- the document

    def outputs(self, frames: list[Frame]) -> dict[int, tuple[str, str]]:
        """Return the names and kinds of all outputs of frames, by port."""
        found = {
            output["port"]: (output["name"], output["kind"]) for output in self.about["outputs"]
        }
        names = {name for name, _ in found.values()}
        for port in sorted({port for frame in frames for port in frame.parts} - {*found}):
            name = f"port{port}"
            while name in names:
                name += "_"
            found[port] = name, "plane"
        return found

    def entry(self, frame: Frame, outputs: dict[int, tuple[str, str]]) -> dict[str, Any]:
        """Return the entry of a frame."""
        values = {
            name: value_of(kind, frame.parts.get(port, []), self.shape)
            for port, (name, kind) in outputs.items()
        }
        shown = {"cycles": frame.cycles, "outputs": values}
        return shown if frame.complete else shown | {"complete": False}

    def document(self) -> dict[str, Any]:
        """Return what docs/json.md describes."""
        setup, *frames = self.frames
        outputs = self.outputs(frames)
        document = {key: self.about[key] for key in ("program", "machine")}
        document["status"] = self.status
        if self.error:
            document["error"] = self.error
        return document | {
            "instructions": sum(frame.instructions for frame in self.frames),
            "cycles": sum(frame.cycles for frame in self.frames),
            "setup": self.entry(setup, self.outputs([setup])),
            "frames": [{"index": k} | self.entry(f, outputs) for k, f in enumerate(frames)],
        }

    def state(self) -> dict[str, Any]:
        """Return the state in which the chip stopped."""
        block = self.about["blocks"][self.last]
        stack, depth = block.get("stack", []), block.get("depth", 0)

        def shown(name: str, number: int, unit: int = 1) -> Any:
            planes = self.planes(self.about["planes"][name], number) // unit
            return planes.reshape(number, *self.shape).tolist()

        self.complete(self.last)
        return {
            "address": self.address,
            "stack": stack,
            "depth": depth,
            "registers": shown("registers", 16),
            "zero": shown("zero", 1, 255)[0],
            "carry": shown("carry", 1, 255)[0],
            "masks": shown("masks", depth, 255),
            "memory": shown("memory", self.about["memory_bytes"]),
        }


def run(files: list[Path], limit: int, partner: list[Frame]) -> Run:
    """Run a program to its end; if a frame breaks a limit or a rule, again from the last refill."""
    wasm, frames = files[0].read_bytes(), np.load(files[1])
    found = Run(wasm, frames, limit, partner)
    if found.over or found.broken:
        found = Run(sections(wasm)["npchip.step"], frames, limit, partner, found.saved)
    found.finish()
    return found


def main() -> None:
    """Run the program that the command line names."""
    parser = argparse.ArgumentParser(description="Run a program's WebAssembly module on a clip.")
    parser.add_argument("program", type=Path, metavar="PROGRAM.wasm")
    parser.add_argument("clip", type=Path, metavar="CLIP.npy")
    parser.add_argument("--max-cycles", type=int, default=50_000_000, metavar="N")
    parser.add_argument("--partner", type=Path, nargs=2, metavar=("PROGRAM.wasm", "CLIP.npy"))
    parser.add_argument("--state", action="store_true")
    given = parser.parse_args()
    partner = run(given.partner, given.max_cycles, []).frames if given.partner else []
    found = run([given.program, given.clip], given.max_cycles, partner)
    print(json.dumps(found.document() | ({"state": found.state()} if given.state else {})))


if __name__ == "__main__":
    main()
