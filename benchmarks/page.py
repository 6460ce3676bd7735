"""The page of docs/ that tells how fast the emulator is, from one run of the benchmarks."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from benchmarks.noise import CONVERSION
from examples.measure import PROGRAMS, table
from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ

Table = Mapping[str, Mapping[str, float]]

NEEDED = (
    "trajectory",
    "pictures",
    "engines",
    "noise",
    "arrays",
    "ready",
    "hard",
    "start-up",
    "growth",
    "many",
    "against",
)
"""Parts of the benchmarks of which it tells; `against` is the comparison with a commit."""

_NOISE = {"ideal": ".2f", "noisy": ".2f", "times of ideal": ".2f", "reference": ",.0f"}
_LARGE = {
    "wasm frames/s": ",.0f",
    "reference frames/s": ",.0f",
    "ratio": ".1f",
    "ready ms": ".1f",
    "ns per NP": ".0f",
    "times of the chip's": ".2f",
}
_READY = ("assemble ms", "compile and one frame ms", "total ms")

_TEXT = """\
# How fast the emulator is

See how fast npchip emulates every program on one computer. The command
`python -m benchmarks --page docs/speed.md --against {commit}` writes this page. Figures are medians
of five, of processor time except for whole processes, all in one run on one core of {computer}.
Other computers give other figures, and so does the same one an hour later; ratios within a run are
steadier.

To see the effect of a change, compare the working tree with a commit:
`python -m benchmarks --against main`, or `--against HEAD~3 --only trajectory,dct --rounds 9`. The
same code measures both by turns, each in a process that stays alive. For every program of `asm/`
it prints frames per second and the time from source to first frame of both, and their ratios:
above 1, the working tree is faster. The geometric means over all programs are accurate to two or
three percent. The ratio of one program needs more rounds, or an otherwise idle computer.

## Frames per second

Every program runs on `coin_slide`, a clip of 64 x 80 pixels that is held in memory; the time
includes feeding frames and collecting results. *Compiled* is the engine that `npchip run` uses,
*reference* the one for stepping and tracing; both give the same results and cycles. *x the chip*
compares the compiled engine with the cycles that it counts, at {mhz} MHz: cycles are decisions of
the machine file, and the clock is illustrative. One instruction is an instruction of the chip,
executed by all 80 NPs.

{programs}

Programs that send whole pictures (`edges`, `smooth`, `median`, `imaging`) pass 5,120 bytes a frame
to Python. In `keypoints`, `recognise` and `trajectory_nonlinear` each NP reads the memory at its
own address. `fusion_lut` asks its partner, a Python function, in every frame.

## The same job by other means

These compute what `trajectory.s` finds without the chip: NumPy for one frame at a time, NumPy for
all frames at once, and C with vector types that executes the program's array instructions one by
one (`benchmarks/`). All give equal results.

{others}

Pictures over 40,000 frames: `frame_difference.s` beside NumPy, `edges.s` beside two ways of OpenCV.
All draw the same. The chip has been compiled before in the rows of its steady state; a cold start
assembles and compiles, too.

{pictures}

## With noise

A sensor with `noise_rms: 5` and `fixed_pattern: 20`. A conversion of 5,120 pixels takes
{conversion:.1f} us in the compiled engine, and {numpy:.1f} us in NumPy, with which the reference
engine converts: {part:.2f} of that. Microseconds a frame:

{noise}

## From a source to its first frame

A process that has imported everything reads and assembles the source, then translates it to
WebAssembly, compiles that and runs one frame.

{ready}

These programs are made to take long (`benchmarks/hard.py`). What nobody writes has a bound and no
other goal: it is ready within a second, or the reference engine runs it and a notice says why.
`python -m benchmarks hard` fails if one does neither.

{hard}

Whole processes, wall-clock time, `npchip run` on `trajectory.s`:

{processes}

## Several clips at once

`Chip.run_many` on two cores beside one chip that runs the clips one after the other, from the
program to all results, by the clock. *Two processes* is the ratio of two processes that begin with
a compiled program, take half of the clips each, and share nothing: what the two cores give.

{many}

## Beside an earlier commit

The programs of `asm/` on the emulator of {commit}, each with the programs of its own time, and now.

{against}

## Growth

`trajectory.s` runs on frames from an iterator; *process* is its peak memory, with all results kept.
The second table shows larger arrays.

{frames}

{arrays}

Programs that draw pictures, on the chip's array, on VGA and on 1,280 x 1,024 pixels; *times the
chip's* is what an NP costs, as a multiple of its cost on 8 x 10. It grows where the NPs' memory,
the frames and the pictures leave the processor's caches.

{large}
"""


def page(results: Mapping[str, Table], commit: str) -> str:
    """Write the page from the tables of `NEEDED`, and the commit that one compares with."""
    growth, conversion = results["growth"], results["noise"][CONVERSION]
    return _TEXT.format(
        computer=_computer(),
        commit=commit,
        many=table(
            ["", "at once, ms", "one after the other, ms", "ratio", "two processes"],
            [
                [
                    f"`{name.split(', ')[0]}`, {name.split(', ')[1]}",
                    f"{row['at once, ms']:,.0f}",
                    f"{row['one chip, in turn, ms']:,.0f}",
                    f"{row['one chip, in turn, times']:.2f}",
                    f"{row['one chip, in turn, ms'] / row['two processes, ms']:.2f}",
                ]
                for name, row in results["many"].items()
            ],
            numbers=4,
        ),
        against=table(
            ["program", "frames/s", "then", "ratio", "ready, ms", "then", "ratio"],
            [_compared(name, row) for name, row in results["against"].items()],
            numbers=6,
        ),
        mhz=ILLUSTRATIVE_CLOCK_HZ // 1_000_000,
        programs=_programs(results["engines"]),
        others=table(
            ["", "frames/s", "times as long"],
            [
                [name, f"{row['frames/s']:,.0f}", f"{row['times of npchip']:.2f}"]
                for name, row in results["trajectory"].items()
            ],
            numbers=2,
        ),
        pictures=table(
            ["", "frames/s", "times as long"],
            _named(results["pictures"], {"frames/s": ",.0f", "times of npchip": ".2f"}),
            numbers=2,
        ),
        conversion=conversion["compiled"],
        numpy=conversion["NumPy"],
        part=conversion["part of NumPy"],
        noise=table(
            ["program", "no noise", "noise", "times as long", "reference, noise"],
            _named({name: results["noise"][name] for name in PROGRAMS}, _NOISE),
            numbers=4,
        ),
        large=table(
            ["NPs", "frames/s", "reference", "ratio", "ready, ms", "ns per NP", "times the chip's"],
            _named(results["arrays"], _LARGE),
            numbers=6,
        ),
        ready=table(
            ["program", "assembled, ms", "compiled and run, ms", "together, ms"],
            [
                [f"`{name}`", *(f"{results['ready'][name][key]:.1f}" for key in _READY)]
                for name in PROGRAMS
            ],
            numbers=3,
        ),
        hard=table(
            ["program", "engine", "words", "assembled, ms", "compiled and run, ms", "together, ms"],
            [
                [
                    name,
                    "compiled" if row["compiled"] else "reference",
                    f"{row['words']:.0f}",
                    *(f"{row[key]:.1f}" for key in _READY),
                ]
                for name, row in results["hard"].items()
            ],
            numbers=4,
        ),
        processes=table(
            ["process", "ms", "times the imports"],
            [
                [f"`{name}`", f"{row['ms']:.0f}", f"{row['times of import']:.2f}"]
                for name, row in results["start-up"].items()
            ],
            numbers=2,
        ),
        frames=table(
            ["frames", "us per frame", "process, MB"],
            [
                [name.split()[0], f"{row['us per frame']:.2f}", f"{row['peak MB']:.0f}"]
                for name, row in growth.items()
                if "peak MB" in row
            ],
            numbers=2,
        ),
        arrays=table(
            ["NPs", "us per frame", "ns per frame and NP"],
            [
                [name.removesuffix(" NPs"), *(f"{value:.2f}" for value in row.values())]
                for name, row in growth.items()
                if "peak MB" not in row
            ],
            numbers=2,
        ),
    )


def _compared(name: str, row: Mapping[str, float]) -> list[str]:
    """Return a row of the comparison with a commit; those of all programs have ratios only."""
    if len(row) == 2:
        steady, ready = row.values()
        return [name, "", "", f"{steady:.2f}", "", "", f"{ready:.2f}"]
    forms = (",.0f", ",.0f", ".2f", ".1f", ".1f", ".2f")
    return [f"`{name}`", *map(format, row.values(), forms)]


def _named(rows: Table, formats: Mapping[str, str]) -> list[list[str]]:
    """Return rows that begin with the name of a program, and then have some of its figures."""
    found = []
    for name, row in rows.items():
        program, *rest = name.removesuffix(" NPs").split(", ", 1)
        figures = [format(row[key], form) for key, form in formats.items()]
        found.append([", ".join([f"`{program}`", *rest]), *figures])
    return found


def _programs(engines: Table) -> str:
    rows = []
    for name in PROGRAMS:
        row = engines[name]
        compiled, reference = row["wasm frames/s"], row["reference frames/s"]
        chip = ILLUSTRATIVE_CLOCK_HZ / row["cycles per frame"]
        figures = [compiled, compiled / chip, row["wasm instructions/s"] / 1e6, reference]
        rows.append([f"`{name}`", *(f"{figure:,.0f}" for figure in figures)])
    head = [
        "program",
        "compiled, frames/s",
        "x the chip",
        "M instructions/s",
        "reference, frames/s",
    ]
    return table(head, rows, numbers=4)


def _computer() -> str:
    """The processor and the versions that matter."""
    processor = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        lines = information.read_text(encoding="utf-8").splitlines()
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
        processor = names[0] if names else processor
    versions = [f"{name} {version(name)}" for name in ("numpy", "wasmtime")]
    return f"{processor} (Python {platform.python_version()}, {', '.join(versions)})"
