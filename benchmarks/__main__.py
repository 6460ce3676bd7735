"""Measure everything in one run: tables, JSON (``--json``), a page of docs/ (``--page``).

``--against COMMIT`` compares the working tree with another commit instead, and ``ablation``
measures what each part of the compiled engine is worth.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import ablation, against, baselines
from benchmarks.arrays import arrays
from benchmarks.debugger import debugger
from benchmarks.growth import growth
from benchmarks.hard import beyond, shown_bounds
from benchmarks.many import many
from benchmarks.measure import interleaved, processor_time, progress
from benchmarks.native import OUTPUTS, Native
from benchmarks.noise import noise
from benchmarks.orientation import orientation
from benchmarks.page import NEEDED, page
from benchmarks.parts import PARTS
from benchmarks.pictures import pictures
from benchmarks.programs import FRAMES, ROOT, long_clip, made, sources
from benchmarks.ready import assembling, hard, ready, start_up
from benchmarks.resize import resize
from benchmarks.studio import studio
from npchip import Chip, Program, assemble

SLOW_FRAMES = 5
ROUNDS = 5
"""Measurements of each program for a comparison, unless the command line says otherwise."""

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
        "pictures": pictures,
        "engines": engines,
        "noise": noise,
        "arrays": arrays,
        "profile": profiles,
        "ready": ready,
        "hard": hard,
        "assembling": lambda _: assembling(),
        "start-up": lambda _: start_up(),
        "orientation": lambda _: orientation(),
        "debugger": debugger,
        "resize": lambda _: resize(),
        "many": many,
        "studio": lambda _: studio(),
    }
    parser = _parser(parts)
    options = parser.parse_args(arguments)
    ablates = "ablation" in options.parts
    if ablates and (len(options.parts) > 1 or options.page or options.against is not None):
        parser.error("ablation takes neither other parts nor --page nor --against")
    if options.page and (options.against is None or options.only):
        parser.error("--page needs --against COMMIT, with all programs")
    if options.page and options.parts and not {*NEEDED} - {"against"} <= {*options.parts}:
        parser.error(f"--page needs the parts {', '.join(NEEDED[:-1])}")
    if options.against is None and not ablates and (options.only or options.rounds is not None):
        parser.error("--only and --rounds belong to --against and ablation")
    if ablates:
        results = {"ablation": _ablation(parser, options)}
    else:
        if options.against is not None and options.parts and not options.page:
            parser.error("--against takes parts only with --page")
        alone = options.against is not None and not options.page
        results = {} if alone else _run(parts, options.parts or parts)
        if options.against is not None:
            results["against"] = _against(parser, options)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if options.page:
        options.page.write_text(page(results, options.against), encoding="utf-8")
    if "hard" in results:
        print(f"\n{shown_bounds(results['hard'])}")
        if beyond(results["hard"]):
            sys.exit(1)


def _parser(parts: Iterable[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "parts",
        nargs="*",
        choices=[*parts, "ablation", []],
        metavar="PART",
        help=f"{', '.join(parts)} (all of them by default); or ablation, alone",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures too")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write docs/speed.md")
    group = parser.add_argument_group("comparing with a commit, or without parts of the engine")
    group.add_argument(
        "--against",
        metavar="COMMIT",
        help="measure the programs of asm/ in the working tree and in COMMIT, in turn",
    )
    group.add_argument(
        "--only",
        type=_names,
        default=[],
        metavar="NAME,NAME",
        help="only these programs, or for ablation these parts",
    )
    group.add_argument(
        "--rounds",
        type=_positive,
        metavar="N",
        help=f"measure each program N times ({ROUNDS})",
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
        table = against.compare(options.against, options.only, options.rounds or ROUNDS)
    except against.RequestError as error:
        parser.exit(2, f"{parser.prog}: error: {error}\n")
    except against.WorkerError as error:
        parser.exit(1, f"{parser.prog}: error: {error}\n")
    except KeyboardInterrupt:
        parser.exit(130)
    print(against.shown(table, options.against))
    return table


def _ablation(parser: argparse.ArgumentParser, options: argparse.Namespace) -> Table:
    known = {part.name: part for part in PARTS}
    for name in options.only:
        if name not in known:
            parser.error(f"no part '{name}'; there are {', '.join(known)}")
    chosen = [known[name] for name in options.only or known]
    with progress(len(sources())) as tick:
        table = ablation.ablation(chosen, options.rounds or ROUNDS, tick)
    print(ablation.shown(table))
    return table


if __name__ == "__main__":
    main()
