"""Run a program that ``npchip asm`` compiled on a clip, and print the JSON of the run.

    python host.py PROGRAM.wasm CLIP.npy [--max-cycles N] [--partner PROGRAM.wasm CLIP.npy]
                                         [--state]

--max-cycles stops a frame that takes more. --partner runs another program first; this one then
receives what its outputs had in the same frame. --state adds the chip's state at the end.
docs/module.md describes the program's file, docs/json.md what is printed.
"""

import argparse
import io
import json
import struct
from pathlib import Path
from typing import Any

from wasmtime import Func, FuncType, Instance, Module, Store, ValType

Send = tuple[int, bytes, set[int]]  # address of the OUT, plane, different bytes of active NPs


def custom_sections(binary: bytes) -> dict[str, bytes]:
    """Return the custom sections of a module by name."""

    def leb128(file: io.BytesIO) -> int:
        byte = file.read(1)[0]
        return byte if byte < 128 else byte - 128 + 128 * leb128(file)

    module, sections = io.BytesIO(binary[8:]), {}
    while kind := module.read(1):
        section = io.BytesIO(module.read(leb128(module)))
        if kind == b"\0":
            name = section.read(leb128(section)).decode()
            sections[name] = section.read()
    return sections


def value_of(kind: str, sends: list[Send], shape: tuple[int, int]) -> Any:
    """Return what a frame's sends to an output make: lists, the bytes of a number, or None."""
    sends = [send for send in sends if send[2] or kind in ("plane", "picture")]
    sends = sends[-1 if kind in ("scalar", "plane") else 0 :]
    if not sends:
        return None
    if len(sends) != {"scalar16": 2, "picture": 64}.get(kind, len(sends)):
        raise ValueError("NP311", sends[-1][0])
    if kind == "plane":
        return memoryview(sends[0][1]).cast("B", shape).tolist()
    if kind == "picture":  # eight sends have a row of each NP's pixels
        starts = [(row * shape[1], k) for row in range(shape[0]) for k in range(0, 64, 8)]
        eights = [[plane[at:][: shape[1]] for _, plane, _ in sends[k : k + 8]] for at, k in starts]
        return [[p for pixels in zip(*eight, strict=True) for p in pixels] for eight in eights]
    for address, _, sent in sends:
        if len(sent) > 1:
            raise ValueError("NP310", address)
    return (list if kind == "list" else bytes)(byte for _, _, sent in sends for byte in sent)


class Run:
    """A run of a program with a clip, from the chip's reset to its end."""

    def __init__(self, limit: int, partner: list[dict[str, Any]], program: str, clip: str) -> None:
        self.limit, self.partner = limit, partner
        self.frames: list[dict[str, Any]] = []  # the setup, then the clip's; outputs by their port
        self.error: dict[str, Any] = {}
        self.saved: tuple[dict[str, Any], bytes] | None = None  # block and state at the last refill
        self.header, _, self.clip = Path(clip).read_bytes().partition(b"\n")  # header is one line
        self.run_form(Path(program).read_bytes())
        if self.tick(self.block) and self.step_form:
            self.run_form(self.step_form)  # the run may be past the limit: go back, stop at it
        self.drain()
        block = self.info["blocks"][self.block]
        other = {"status": "failed" if "port" in block else "frames-exhausted", "code": "NP306"}
        end: dict[str, Any] = block.get("exit", other)
        if self.tick(self.block):
            end = {"status": "cycle-limit"}
        if end["status"] == "failed":
            self.error = {"code": end["code"], "address": block["address"]}
        halted = end["status"] == "halted"  # the HALT is executed
        self.place = block["address"] + halted, block.get("stack", []), block.get("depth", 0)
        if end["status"] != "frames-exhausted":
            cycles = self.get("cycles") + end.get("cycles", 0)
            self.add_frame(cycles, self.get("instructions") + halted, halted)
        self.status = "failed" if self.error else end["status"]

    def run_form(self, binary: bytes) -> None:
        """Run a form from the last refill, or the beginning; methods have the requests' names."""
        sections = custom_sections(binary)
        self.info: dict[str, Any] = json.loads(sections["npchip"])
        self.step_form = sections.get("npchip.step")  # the stepping form itself has no other
        rows, cols = self.shape = self.info["np_rows"], self.info["np_cols"]
        self.size = rows * cols
        for text in (shape := f", {8 * rows}, {8 * cols})", "|u1"):
            assert text in str(self.header), f"the clip is not uint8 of shape (n{shape}"
        self.control = {name: (at, 4) for name, at in self.info["words"].items()}
        self.control |= {name: (at, 8) for name, at in self.info["longs"].items()}
        methods = {number: getattr(self, name) for name, number in self.info["requests"].items()}
        store, i32 = Store(), ValType.i32()
        ask = Func(store, FuncType([i32, i32], [i32]), lambda i, block: methods[i](block))
        exports: Any = Instance(store, Module(store.engine, binary), [ask]).exports(store)
        self.store, self.memory, self.complete = store, exports["memory"], exports["complete"]
        block, state = self.saved or (self.info["blocks"][0], b"")  # blocks of both forms are alike
        self.memory.write(self.store, state, 0)
        self.put(frame=self.info["frames"]["first"], check=self.limit, first_check=self.limit)
        self.put(closed=0, log_end=self.info["log"], data_end=self.info["data"])
        self.sends: dict[int, list[Send]] = {}  # of a frame, by port
        self.inputs: dict[int, Any] = {}  # of a frame, by port
        self.block: int = exports["run"](store, self.info["blocks"].index(block))

    def read(self, at: int, size: int) -> bytes:
        """Return bytes of the module's memory."""
        return bytes(self.memory.read(self.store, at, at + size))

    def get(self, name: str) -> int:
        """Return a control word."""
        return int.from_bytes(self.read(*self.control[name]), "little")

    def put(self, **numbers: int) -> None:
        """Write control words."""
        for name, number in numbers.items():
            at, size = self.control[name]
            self.memory.write(self.store, number.to_bytes(size, "little"), at)

    def tick(self, block: int) -> int:
        """Tell whether the frame has broken the limit; if not, be asked at the next instruction."""
        cycles, exposes = self.get("cycles"), self.info["blocks"][block].get("exposes", False)
        self.put(check=cycles + 1)
        return int(cycles >= self.limit + exposes)

    def drain(self, _: int = 0) -> int:
        """Take what the frame has sent."""
        log, at, stride = self.info["log"], self.info["data"], self.info["stride"]
        for (entry,) in struct.iter_unpack("<I", self.read(log, self.get("log_end") - log)):
            site = self.info["sites"][entry >> 8]
            plane = self.read(at, self.size) if site["planes"] else bytes([entry & 255]) * self.size
            active = self.read(at + stride, self.size) if site["planes"] == 2 else b"1" * self.size
            sent = {byte for byte, on in zip(plane, active, strict=True) if on}
            self.sends.setdefault(site["port"], []).append((site["address"], plane, sent))
            at += site["planes"] * stride
        self.put(closed=0, log_end=log, data_end=self.info["data"])
        return 0

    def refill(self, block: int) -> int:
        """Take the complete frame, and give just one: so none runs after one that broke a rule."""
        self.drain()
        cycles, instructions = struct.unpack("<QQ", self.read(self.info["records"], 16))
        if instructions or not self.frames:  # going back closes a frame that never was
            self.add_frame(cycles, instructions, True)
        self.complete(self.store, block)
        self.saved = self.info["blocks"][block], self.read(0, self.info["state_end"])
        number, size = len(self.frames), self.info["frames"]["bytes"]  # the setup counts too
        frame = self.clip[(number - 1) * size : number * size]
        if self.error or not frame:
            return 0
        self.memory.write(self.store, frame, self.info["frames"]["ring"])
        self.put(taken=number - 1, position=0, available=1)
        sent = self.partner[number]["outputs"] if number < len(self.partner) else {}
        self.inputs = {port: iter(value or []) for port, value in sent.items()}
        return 1

    def receive(self, block: int) -> int:
        """Give all NPs the next byte from the partner."""
        byte = next(self.inputs.get(self.info["blocks"][block]["port"], iter([])), None)
        if isinstance(byte, int):  # not None, nor a row of a plane
            at = self.info["planes"]["received"]
            self.memory.write(self.store, bytes([byte]) * self.size, at)
        return int(isinstance(byte, int))

    def add_frame(self, cycles: int, instructions: int, complete: bool) -> None:
        """Add the present frame, with its outputs by port."""
        declared = {output["port"]: output["kind"] for output in self.info["outputs"]}
        kinds = declared | dict.fromkeys(self.sends.keys() - declared, "plane")
        try:
            values = {p: value_of(kinds[p], self.sends.get(p, []), self.shape) for p in kinds}
        except ValueError as broken:
            values, (code, address) = dict.fromkeys(declared), broken.args
            self.error = {"code": code, "address": address} if complete else self.error
            complete = False
        frame = {"cycles": cycles, "instructions": instructions, "outputs": values}
        self.frames.append(frame if complete else frame | {"complete": False})
        self.sends = {}

    def document(self, with_state: bool) -> dict[str, Any]:
        """Return what docs/json.md describes."""
        names = {output["port"]: output["name"] for output in self.info["outputs"]}
        declared = set(names.values())
        for port in sorted(set(range(16)) - names.keys()):
            names[port] = f"port{port}"
            while names[port] in declared:
                names[port] += "_"
        (setup, *frames), info = self.frames, self.info
        sent = {port for frame in frames for port in frame["outputs"]}
        for frame, ports in [(setup, set(setup["outputs"])), *((frame, sent) for frame in frames)]:
            frame["outputs"] = {names[p]: frame["outputs"].get(p) for p in names if p in ports}
        result = {"program": info["program"], "machine": info["machine"], "status": self.status}
        result |= {"error": self.error} if self.error else {}
        result["instructions"] = sum(frame.pop("instructions") for frame in self.frames)
        result["cycles"] = sum(frame["cycles"] for frame in self.frames)
        result |= {"setup": setup, "frames": [{"index": i} | f for i, f in enumerate(frames)]}
        if not with_state:
            return result
        self.complete(self.store, self.block)
        state: dict[str, Any] = dict(zip(("address", "stack", "depth"), self.place, strict=True))
        numbers = {"registers": 16, "zero": 1, "carry": 1, "masks": state["depth"]}
        for name, number in (numbers | {"memory": self.info["memory_bytes"]}).items():
            at, bits = self.info["planes"][name], 255 if name in ("registers", "memory") else 1
            planes = [self.read(at + i * info["stride"], self.size) for i in range(number)]
            views = [memoryview(bytes(byte & bits for byte in plane)) for plane in planes]
            state[name] = [view.cast("B", self.shape).tolist() for view in views]
        return result | {"state": state | {flag: state[flag][0] for flag in ("zero", "carry")}}


def main(arguments: list[str] | None = None) -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(description="Run a program from `npchip asm`.")
    parser.add_argument("program", metavar="PROGRAM.wasm")
    parser.add_argument("clip", metavar="CLIP.npy")
    parser.add_argument("--max-cycles", type=int, default=50_000_000, metavar="N")
    parser.add_argument("--partner", nargs=2, metavar=("PROGRAM.wasm", "CLIP.npy"))
    parser.add_argument("--state", action="store_true")
    args = parser.parse_args(arguments)
    partner = Run(args.max_cycles, [], *args.partner).frames if args.partner else []
    run = Run(args.max_cycles, partner, args.program, args.clip)
    # Numbers are still the bytes that were sent, the low one first.
    print(json.dumps(run.document(args.state), default=lambda sent: int.from_bytes(sent, "little")))


if __name__ == "__main__":
    main()
