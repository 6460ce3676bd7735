"""Run all programs of asm/ on both machines, and write docs/programs.md.

    python -m examples.programs_page [FILE]

Outputs and constants are those that the head of each source states; the tests hold them against its
`.output` and `.equ` lines. The same figures come out on every computer.
"""

from __future__ import annotations

import re
from itertools import combinations
from textwrap import fill
from typing import TYPE_CHECKING, NamedTuple

from examples.measure import MACHINES, PROGRAMS, ROOT, run, table, write_page
from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip.report.comparison import Column

TASKS = ("sampling", "compute", "memory", "reduction", "flow", "output")

TEXT = """\
# The programs

Find a program of [`asm/`](../asm), its size, cost, outputs and constants. Every figure is measured
in a run (`python -m examples.programs_page`). Each program gives exactly the result of an
independent calculation on all bundled clips and on 1,000 random scenes or more
(`tests/asm/test_*.py`; `NPCHIP_PROFILE=thorough` runs all scenes). Scripts read outputs as
[JSON](json.md).

{programs}

*Most cycles* is the `.budget` that a program sets itself for the worst frame on the default
machine, whatever the frame shows; `npchip run` and `npchip test` check it. `keypoints.s` and
`recognise.s` reach it only on a frame that is a grid of holes.

## Cycles per frame

Cycles are decisions of a machine file, not the silicon's, so the table shows two machines:
[`default` and `conservative`](machine.md). Frames per second assume a clock of {mhz} MHz,
which is illustrative; exposure time is not counted.

{cycles}

{order}

## Where the cycles go

Shares of the cycles of the whole run, in per cent. *Reduction* is what NPs find out together: the
global OR, and reading a neighbour ([timing classes of each task](compare.md)). On the default
machine two conversions take {picture_default} cycles of every frame, and so does sending a picture;
on the conservative machine {picture_conservative}. The simple programs do little else.

### `default`

{shares_default}

### `conservative`

{shares_conservative}

`npchip compare asm/edges.s asm/median.s --frames CLIP` shows the same for any program on any clip.

## Outputs

{outputs}

`scalar` and `scalar16` are numbers of 8 and 16 bits, `list` is several of 8 bits, `plane` one for
each NP, `picture` one for each pixel.

## Constants

Set them with `--define NAME=VALUE`.

{constants}
"""


class Entry(NamedTuple):
    """An output or a constant of a head."""

    name: str
    kind: str
    text: str


def head_of(name: str) -> list[str]:
    """Lines of the comment at the top of a source, without the semicolons."""
    lines = (ROOT / "asm" / f"{name}.s").read_text(encoding="utf-8").splitlines()
    return [line[2:] for line in lines[: next(i for i, x in enumerate(lines) if x[:1] != ";")]]


def entries(name: str, title: str) -> Iterator[Entry]:
    """Outputs (title "Output") or constants (title "Constant") as a head states them."""
    kinds = r"(scalar16|scalar|list|plane|picture) +" if title == "Output" else "()"
    inside, found = False, Entry("", "", "")
    for line in head_of(name):
        if line[:1].strip():
            inside = line.startswith(title)
            if not inside and found.name:
                break
        if not inside:
            continue
        if new := re.fullmatch(rf".{{10}}((?:\w+, )*\w+) +{kinds}(.+)", line):
            if found.name:
                yield found
            found = Entry(new[1], new[2], new[3])
        else:
            found = found._replace(text=f"{found.text} {line.strip()}")  # goes on far to the right
    if found.name:
        yield found


def programs() -> str:
    """Words and budgets."""
    rows = []
    for name in PROGRAMS:
        program = run(name).program
        does = head_of(name)[0].partition(" - ")[2].replace("|", "\\|")
        assert program.budget.cycles
        words = len(program.words)
        rows.append([link(name), does, f"{words}", f"{program.budget.cycles:,}"])
    return table(["program", "does", "words of 512", "most cycles"], rows, 2)


def link(name: str) -> str:
    """Name of a program, with a link to it."""
    return f"[`{name}.s`](../asm/{name}.s)"


def cycles() -> str:
    """Mean and worst frame on both machines."""
    rows = []
    for name in PROGRAMS:
        cells = [f"`{name}`", f"`{run(name).clip}`"]
        for machine in MACHINES:
            column = run(name, machine).column
            rate = ILLUSTRATIVE_CLOCK_HZ / column.cycles
            cells += [f"{column.cycles:,.0f}", f"{column.worst:,}", f"{rate:,.0f}"]
        rows.append(cells)
    head = ["program", "clip", "mean", "worst", "frames/s"]
    return table([*head, *(f"{title}, conservative" for title in head[2:])], rows, 6)


def order() -> str:
    """Say which comparisons of programs the machines disagree on."""
    flips = [
        f"`{a}` and `{b}`"
        for a, b in combinations(PROGRAMS, 2)
        if len({run(a, m).column.cycles < run(b, m).column.cycles for m in MACHINES}) > 1
    ]
    if not flips:
        return "On both machines the programs have the same order by cycles."
    pairs = len(PROGRAMS) * (len(PROGRAMS) - 1) // 2
    return fill(
        f"The machines disagree on the faster program in {len(flips)} of {pairs} pairs:"
        f" {'; '.join(flips)}. Which of these is faster depends on timing that nobody published.",
        105,
    )


def shares(machine: str) -> str:
    """Cycles by task."""
    columns = {name: run(name, machine).column for name in PROGRAMS}
    assert all(sum(map(column.share, TASKS)) > 0.9999 for column in columns.values())
    rows = [[f"`{name}`", *share_cells(column)] for name, column in columns.items()]
    return table(["%", *TASKS], rows, len(TASKS))


def share_cells(column: Column) -> list[str]:
    """Per cent of each task."""
    return [f"{100 * column.share(task):.1f}" for task in TASKS]


def stated(title: str, head: list[str]) -> str:
    """Outputs or constants of all programs."""
    rows = []
    for name in PROGRAMS:
        for index, entry in enumerate(entries(name, title)):
            kind = [entry.kind] if entry.kind else []
            text = entry.text.replace("|", "\\|")
            names = ", ".join(f"`{each}`" for each in entry.name.split(", "))
            rows.append([f"`{name}`" if index == 0 else "", names, *kind, text])
    return table(head, rows)


def document() -> str:
    """Return the text of docs/programs.md."""
    timing = {m: run("imaging", m).column.machine.cycles for m in MACHINES}
    assert all(64 * time("output") == 2 * time("sample") for time in timing.values())
    return TEXT.format(
        programs=programs(),
        mhz=ILLUSTRATIVE_CLOCK_HZ // 1_000_000,
        cycles=cycles(),
        order=order(),
        **{f"picture_{m}": f"{2 * timing[m]('sample'):,}" for m in MACHINES},
        **{f"shares_{m}": shares(m) for m in MACHINES},
        outputs=stated("Output", ["program", "output", "kind", "what it is"]),
        constants=stated("Constant", ["program", "constant", "values"]),
    )


if __name__ == "__main__":
    write_page("programs.md", document)
