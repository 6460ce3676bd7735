"""Measure everything in one run: tables, JSON (``--json``), a page of docs/ (``--page``).

``--against COMMIT`` compares the working tree with another commit instead.
"""

from __future__ import annotations

import argparse
import compileall
import json
import resource
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import against, baselines
from benchmarks import hard as hardest
from benchmarks.debugger import debugger
from benchmarks.many import many
from benchmarks.measure import interleaved, processes, processor_time
from benchmarks.native import OUTPUTS, Native
from benchmarks.orientation import orientation
from benchmarks.page import NEEDED, page
from benchmarks.programs import CLIP, FRAMES, ROOT, long_clip, made, sources
from benchmarks.resize import resize
from npchip import Chip, Program, assemble, assemble_text, load_machine
from npchip.assembler import disassemble
from npchip.isa import load_isa

SLOW_FRAMES, GROWN_FRAMES = 5, 1_000

_COUNTING = ("run", "profile")

Table = dict[str, dict[str, float]]


def programs() -> dict[str, Program]:
    """Every program of ``asm/``."""
    return {name: assemble(path) for name, path in sources().items()}


def engines(clip: Any) -> Table:
    """Frames and array instructions per second of each program on both engines."""
    table: Table = {}
    for name, program in programs().items():
        row: dict[str, float] = {}
        for engine, count in (("wasm", FRAMES), ("reference", SLOW_FRAMES)):
            frames = clip[:count]
            chip = made(program, engine=engine)
            chip.run(frames[:2])
            while True:
                chip.reset()
                seconds = processor_time(lambda c=chip, f=frames: c.run(f), 1)  # type: ignore[misc]
                if engine == "reference" or seconds < 1 or len(frames) < 100:
                    break
                frames = frames[: len(frames) // 4]  # a program of many cycles

            def work(chip: Chip = chip, frames: Any = frames) -> None:
                chip.reset()
                chip.run(frames)

            seconds = processor_time(work)
            row[f"{engine} frames/s"] = chip.frames_taken / seconds
            row[f"{engine} instructions/s"] = chip.instructions / seconds
            if engine == "wasm":
                row["cycles per frame"] = chip.cycles / chip.frames_taken
        table[name] = row
    return table


def trajectory(clip: Any) -> Table:
    """The same job by other means, checked for equal results."""
    chip, native = Chip(assemble(ROOT / "asm" / "trajectory.s"), engine="wasm"), Native()
    result, expected = chip.run(clip), native.trajectory(clip)
    for index, name in enumerate(OUTPUTS):
        np.testing.assert_array_equal(result.outputs[name], expected[:, index], name)
    boxes = baselines.each_frame(clip)
    np.testing.assert_array_equal(boxes, baselines.batched(clip))
    np.testing.assert_array_equal((boxes[:, 1] + boxes[:, 2]) // 2, expected[:, 1])
    np.testing.assert_array_equal((boxes[:, 3] + boxes[:, 4]) // 2, expected[:, 2])

    def emulated() -> None:
        chip.reset()
        chip.run(clip)

    times = interleaved(
        {
            "npchip (wasm)": emulated,
            "native limit (C)": lambda: native.trajectory(clip),
            "NumPy int16, frame by frame": lambda: baselines.each_frame(clip),
            "NumPy uint8, batched": lambda: baselines.batched(clip),
        }
    )
    ours = times["npchip (wasm)"]
    return {
        name: {"frames/s": len(clip) / seconds, "times of npchip": seconds / ours}
        for name, seconds in times.items()
    }


def profiles(clip: Any) -> Table:
    """Measure the cost of counting for a profile, for each program on the compiled engine."""
    table: Table = {}
    for name, program in programs().items():
        chips = {key: made(program, engine="wasm", profile=key == "profile") for key in _COUNTING}
        frames = clip[:FRAMES]
        for chip in chips.values():
            chip.run(frames[:2])
        while True:
            chips["run"].reset()
            if processor_time(lambda c=chips["run"], f=frames: c.run(f), 1) < 0.1:  # type: ignore[misc]
                break
            frames = frames[: len(frames) // 2]

        def work(chip: Chip, frames: Any = frames) -> None:
            chip.reset()
            chip.run(frames)

        times = interleaved({key: lambda c=chip: work(c) for key, chip in chips.items()})  # type: ignore[misc]
        table[name] = {f"{key} us per frame": 1e6 * t / len(frames) for key, t in times.items()}
        table[name]["times of run"] = times["profile"] / times["run"]
    ratios = [row["times of run"] for row in table.values()]
    table["all programs, geometric mean"] = {"times of run": float(np.exp(np.log(ratios).mean()))}
    return table


def ready(clip: Any) -> Table:
    """From source to the first frame's result, in milliseconds of processor time."""
    return _ready({name: partial(assemble, path) for name, path in sources().items()}, clip)


def hard(clip: Any) -> Table:
    """The same for programs of up to 512 words that are made to take long."""
    sources = hardest.PROGRAMS.items()
    makers = {name: partial(assemble_text, source) for name, source in sources}
    words = {name: {"words": len(make().words)} for name, make in makers.items()}
    return {name: words[name] | row for name, row in _ready(makers, clip).items()}


def _ready(makers: Mapping[str, Callable[[], Program]], clip: Any) -> Table:
    """All programs in turn, as the machine may be slow for as long as one of them takes."""
    works: dict[str, Callable[[], object]] = {}
    for name, make in makers.items():
        program = make()
        works[f"{name}, assemble"] = make
        works[name] = lambda p=program: made(p).run(clip[:1])  # type: ignore[misc]
    times = interleaved(works)
    table: Table = {}
    for name in makers:
        first, then = 1000 * times[f"{name}, assemble"], 1000 * times[name]
        table[name] = {"assemble ms": first, "compile and one frame ms": then}
        table[name]["total ms"] = first + then
    return table


def assembling() -> Table:
    """A program ROM of 512 words from its source, in milliseconds of processor time."""
    program = assemble(ROOT / "asm" / "dct.s")
    text = disassemble(program, load_isa())
    text += "        NOP\n" * (512 - len(program.words))
    sources = {
        "512 words, an instruction a line": lambda: assemble_text(text),
        f"dct.s, {len(program.words)} words from macros": lambda: assemble(ROOT / "asm" / "dct.s"),
    }
    return {name: {"ms": 1000 * value} for name, value in interleaved(sources).items()}


def start_up() -> Table:
    """Whole processes against the imports that they cannot do without.

    The package is compiled to bytecode first, as it is wherever it has been installed.
    """
    compileall.compile_dir(ROOT / "src", quiet=1)
    npchip = [sys.executable, "-m", "npchip"]
    run = [*npchip, "run", str(ROOT / "asm" / "trajectory.s"), "--json", "--frames"]
    clip = np.load(CLIP)
    with tempfile.TemporaryDirectory() as folder:
        clips = {count: str(Path(folder) / f"{count}.npy") for count in (15, 300)}
        for count, file in clips.items():
            np.save(file, np.concatenate([clip] * 10)[:count])
        times = processes(
            {
                "import numpy, yaml": [sys.executable, "-c", "import numpy, yaml"],
                "npchip --help": [*npchip, "--help"],
                "import numpy, wasmtime, yaml": [
                    sys.executable,
                    "-c",
                    "import numpy, wasmtime, yaml",
                ],
                "npchip run, 15 frames": [*run, clips[15]],
                "npchip run, 300 frames": [*run, clips[300]],
            }
        )
    small, large = times["import numpy, yaml"], times["import numpy, wasmtime, yaml"]
    bases = {"npchip --help": small, "npchip run, 15 frames": large}
    bases["npchip run, 300 frames"] = large
    return {
        name: {"ms": 1000 * value, "times of import": value / bases.get(name, value)}
        for name, value in times.items()
    }


def growth(clip: Any) -> Table:
    """Over frames (streamed from an iterator, with peak memory) and over the array's size."""
    table: Table = {}
    chip = Chip(assemble(ROOT / "asm" / "trajectory.s"), engine="wasm")
    chip.run(clip[:2])
    for count in (100, 1_000, 10_000, 100_000, 1_000_000):
        chip.reset()
        stream = (clip[index % len(clip)] for index in range(count))
        seconds = processor_time(lambda s=stream: chip.run(s), 1)  # type: ignore[misc]
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        table[f"{count:,} frames"] = {"us per frame": 1e6 * seconds / count, "peak MB": peak}
    for shape in ((8, 10), (16, 16), (16, 20), (32, 32)):
        machine = replace(load_machine("default"), name="grown", np_rows=shape[0], np_cols=shape[1])
        program = assemble(ROOT / "asm" / "trajectory.s", machine)
        frames = np.resize(clip, (GROWN_FRAMES, machine.rows, machine.cols))
        large = Chip(program, machine, engine="wasm")
        large.run(frames[:2])

        def work(chip: Chip = large, frames: Any = frames) -> None:
            chip.reset()
            chip.run(frames)

        seconds = processor_time(work)
        nps = shape[0] * shape[1]
        table[f"{shape[0]} x {shape[1]} NPs"] = {
            "us per frame": 1e6 * seconds / len(frames),
            "ns per frame and NP": 1e9 * seconds / len(frames) / nps,
        }
    return table


def show(title: str, table: Table) -> None:
    """Print a table."""
    print(f"\n{title}")
    for name, row in table.items():
        cells = "  ".join(f"{key} {value:>14,.2f}" for key, value in row.items())
        print(f"  {name:<30} {cells}")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run all, or the parts that are named, or compare with a commit."""
    parts: dict[str, Callable[[Any], Table]] = {
        "growth": growth,  # first: its peaks are those of the process
        "trajectory": trajectory,
        "engines": engines,
        "profile": profiles,
        "ready": ready,
        "hard": hard,
        "assembling": lambda _: assembling(),
        "start-up": lambda _: start_up(),
        "orientation": lambda _: orientation(),
        "debugger": debugger,
        "resize": lambda _: resize(),
        "many": many,
    }
    parser = _parser(parts)
    options = parser.parse_args(arguments)
    if options.page and options.parts and not {*NEEDED} <= {*options.parts}:
        parser.error(f"--page needs the parts {', '.join(NEEDED)}")
    if options.against is None and (options.only or options.rounds is not None):
        parser.error("--only and --rounds belong to --against")
    if options.against is not None:
        if options.parts or options.page:
            parser.error("--against takes neither parts nor --page")
        results = {"against": _against(parser, options)}
    else:
        results = _run(parts, options.parts or parts)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if options.page:
        options.page.write_text(page(results), encoding="utf-8")


def _parser(parts: Iterable[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "parts", nargs="*", choices=[*parts, []], metavar="PART", help=str([*parts])
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures too")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write docs/speed.md")
    group = parser.add_argument_group("comparing with a commit")
    group.add_argument(
        "--against",
        metavar="COMMIT",
        help="measure the programs of asm/ in the working tree and in COMMIT, in turn",
    )
    group.add_argument(
        "--only", type=_names, default=[], metavar="NAME,NAME", help="only these programs"
    )
    group.add_argument(
        "--rounds",
        type=_positive,
        metavar="N",
        help=f"measure each program N times ({against.ROUNDS})",
    )
    return parser


def _names(text: str) -> list[str]:
    return [name for name in (part.strip() for part in text.split(",")) if name]


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError("expected a number above 0")
    return int(text)


def _run(parts: Mapping[str, Callable[[Any], Table]], chosen: Iterable[str]) -> dict[str, Table]:
    clip = long_clip()
    results: dict[str, Table] = {}
    for name in chosen:
        results[name] = parts[name](clip)
        show(name, results[name])
    return results


def _against(parser: argparse.ArgumentParser, options: argparse.Namespace) -> Table:
    try:
        table = against.compare(options.against, options.only, options.rounds or against.ROUNDS)
    except against.RequestError as error:
        parser.exit(2, f"{parser.prog}: error: {error}\n")
    except against.WorkerError as error:
        parser.exit(1, f"{parser.prog}: error: {error}\n")
    except KeyboardInterrupt:
        parser.exit(130)
    print(against.shown(table, options.against))
    return table


if __name__ == "__main__":
    main()
