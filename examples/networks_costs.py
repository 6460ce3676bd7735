"""Costs of networks and their rivals, and of changes to the chip: parts of docs/networks.md.

Their text is in networks_costs.md beside this file; `examples.networks_page` writes the page.
Studies of another chip are in examples/studies.
"""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from examples import silicon
from examples.kernels_page import NAMED
from examples.measure import CLIPS, MACHINES, ROOT, table
from examples.measure import run as run_of
from examples.studies import measures
from examples.studies.rewritten import DIFFERENCE, LARGE, MULTIPLIED, UNROLLED
from examples.studies.study import FOLDER, Study, changed, cost
from examples.sweeps import robustness
from npchip.host.vision.networks import accuracy
from npchip.kernels import Compiled, compile_kernels, read_kernel
from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

TEMPLATE = Path(__file__).with_suffix(".md")
NOISE = 10
"""Noise of a conversion, in the column of noise."""

KERNELS = (
    ("gauss_5",),
    ("log_5",),
    ("binomial", "binomial_5"),
    ("identity", "binomial", "laplace", "sobel_x"),
    ("kirsch", "scharr_x", "laplace_8"),
    ("gauss_5", "binomial_5"),
)
"""Kernels, compiled for 512 words and for 1,024."""
DIFFERENCES = ("frame_difference", "trajectory", "trajectory_nonlinear", "recognise")
"""Programs of asm/ that `silicon` rewrites with ``ABSD``."""
STUDIES = "examples/studies"
NEARLY_FULL, FULL = 230, 4
"""Nine tenths of the memory in bytes, and how many programs of the comparison fill them."""


class Row(NamedTuple):
    """A program in the comparison.

    Attributes:
        what: link and purpose.
        words: its words.
        memory: bytes of an NP's memory.
        cycles: of a mean frame, on each machine.
        right: how often it is right, quiet and with noise.
    """

    what: str
    words: int
    memory: int
    cycles: tuple[float, ...]
    right: tuple[str, str]

    def cells(self) -> list[str]:
        """Return the row's cells."""
        rates = [f"{ILLUSTRATIVE_CLOCK_HZ / each:,.0f}" for each in self.cycles]
        counts = [f"{each:,.0f}" for each in self.cycles]
        return [
            self.what,
            str(self.words),
            str(self.memory),
            *(cell for pair in zip(counts, rates, strict=True) for cell in pair),
            *self.right,
        ]


HEAD = (
    "program",
    "words",
    "bytes",
    "cycles",
    "frames/s",
    "cycles, conservative",
    "frames/s",
    "right",
    f"right, σ {NOISE}",
)
EXACT = ("exact", "–")


@cache
def kernels(names: Sequence[str], *, large: bool = False) -> Compiled:
    """Compile kernels of docs/kernels.md to one program, for 512 words or for 1,024."""
    wanted = [read_kernel(NAMED[name][0], name, **NAMED[name][1]) for name in names]
    return compile_kernels(wanted, [str(FOLDER / name) for name in LARGE] if large else MACHINES)


def compiled_row(*names: str) -> Row:
    """Return the row of a program that `npchip kernel` makes."""
    made = kernels(names)
    title = f"`npchip kernel`: {', '.join(f'`{name}`' for name in names)}"
    used = measures.memory_needed(made.program, np.load(CLIPS / "coin_slide.npy")[:2])
    return Row(title, len(made.program.words), used, tuple(made.cycles.values()), EXACT)


def row(file: str, does: str, right: tuple[str, str] = EXACT) -> Row:
    """Return the row of a program, measured on its own test run.

    Args:
        file: its source, below the working copy.
        does: what it is for.
        right: how often it is right.
    """
    costs = [cost(file, machine) for machine in MACHINES]
    title = f"[`{Path(file).name}`](../{file}): {does}"
    used = measures.memory_used(ROOT / file)
    return Row(title, costs[0].words, used, tuple(each.mean for each in costs), right)


def digits_row() -> Row:
    """Return the row of the network that reads digits, measured on pictures it has not seen."""
    means = [float(measures.digits(0, machine)[1].frame_cycles.mean()) for machine in MACHINES]
    right = share(lambda sigma: measures.digits(sigma)[0].value)
    found = row("asm/digits.s", "a handwritten digit", right)
    return found._replace(cycles=tuple(means))


def triangle_row(name: str, does: str, right: tuple[str, str]) -> Row:
    """Return the row of a program that sees a triangle, measured on those it is judged by."""
    found = row(f"asm/{name}.s", does, right)
    return found._replace(cycles=tuple(measures.cycles(name, machine) for machine in MACHINES))


def share(measure: Callable[[float], float]) -> tuple[str, str]:
    """Return how often something is right, quiet and with noise."""
    return percent(measure(0)), percent(measure(NOISE))


def percent(part: float) -> str:
    """Return a part of the whole in per cent."""
    return f"{100 * part:.1f} %"


@cache
def rows() -> dict[str, Row]:
    """Return all that recognises, and what it is made from."""
    errors = measures.distance(0, measures.TRAINED), measures.distance(NOISE, measures.ROBUST)
    return {
        "digits": digits_row(),
        "orientation": triangle_row(
            "orientation",
            "a distance, by 15 neurons on the sides of a triangle",
            (f"± {errors[0]:.0f} mm", f"± {errors[1]:.0f} mm"),
        ),
        "keypoints": triangle_row(
            "keypoints", "corners, along the edge", share(partial(measures.corners, "keypoints"))
        ),
        "farthest": triangle_row(
            "keypoints_farthest",
            "corners, the farthest points",
            share(partial(measures.corners, "keypoints_farthest")),
        ),
        "correlate": row("asm/correlate.s", "products with a template, at one place"),
        "blocks": row(
            f"{STUDIES}/block_matching.s", "where 80 blocks have gone", share(measures.blocks)
        ),
        "pyramid": row(f"{STUDIES}/pyramid.s", "half the resolution"),
        "smooth": compiled_row("binomial"),
        "sobel": compiled_row("sobel_x", "sobel_y"),
        "gauss": compiled_row("gauss_5"),
    }


def side_by_side() -> str:
    """Return the table of all programs."""
    return table(HEAD, [each.cells() for each in rows().values()], len(HEAD) - 1)


class Saving(NamedTuple):
    """Words and cycles that a study has saved.

    Attributes:
        name: of the program.
        words: before and after.
        cycles: of a mean frame, before and after, on each machine.
    """

    name: str
    words: tuple[int, int]
    cycles: tuple[tuple[float, float], ...]

    def less(self, machine: int) -> float:
        """Return the part of the cycles that is saved, in per cent."""
        before, after = self.cycles[machine]
        return 100 * (1 - after / before)

    def cells(self) -> list[str]:
        """Return the row's cells."""
        pairs = [f"{before:,.0f} → {after:,.0f}" for before, after in self.cycles]
        shares = [f"{self.less(number):.1f} %" for number in range(len(self.cycles))]
        words = f"{self.words[0]} → {self.words[1]}"
        return [
            self.name,
            words,
            *(cell for pair in zip(pairs, shares, strict=True) for cell in pair),
        ]


def studied(name: str, study: Study) -> Saving:
    """Return what a study saves; its second machine is compared with the conservative one."""
    before = [cost(study.program, machine) for machine in MACHINES]
    after = [changed(study, machine) for machine in study.machines]
    cycles = tuple((a.mean, b.mean) for a, b in zip(before, after, strict=True))
    return Saving(f"`{name}`", (before[0].words, after[0].words), cycles)


def substituted(name: str, instruction: str) -> Saving:
    """Return what an instruction of examples/silicon.yaml saves in a program of asm/."""
    before = [run_of(name, machine).column for machine in MACHINES]
    after = [silicon.changed(name, (instruction,), machine) for machine in MACHINES]
    means = [float(result.frame_cycles.mean()) for _, result in after]
    cycles = tuple((each.cycles, mean) for each, mean in zip(before, means, strict=True))
    return Saving(f"`{name}`", (before[0].words, after[0][0]), cycles)


def savings(found: Sequence[Saving], second: str = "conservative") -> str:
    """Return the table of some studies."""
    head = ["program", "words", "cycles", "saved", f"cycles, {second}", "saved"]
    return table(head, [each.cells() for each in found], len(head) - 1)


def multiplication() -> list[Saving]:
    """Return what ``MUL`` saves."""
    return [studied(name, study) for name, study in MULTIPLIED.items()]


def difference() -> list[Saving]:
    """Return what ``ABSD`` saves."""
    rest = [substituted(name, "ABSD") for name in DIFFERENCES]
    return [studied("block_matching", DIFFERENCE), *rest]


def halving() -> list[Saving]:
    """Return what ``ASR`` saves."""
    return [substituted("dct", "ASR")]


def larger_kernels(names: tuple[str, ...]) -> Saving:
    """Return what 512 more words save where kernels are compiled."""
    before, after = kernels(names), kernels(names, large=True)
    pairs = zip(before.cycles.values(), after.cycles.values(), strict=True)
    words = len(before.program.words), len(after.program.words)
    return Saving(", ".join(f"`{name}`" for name in names), words, tuple(pairs))


def more_words() -> list[Saving]:
    """Return what 512 more words save."""
    return [*(larger_kernels(names) for names in KERNELS), studied("block_matching", UNROLLED)]


def span(found: Sequence[Saving]) -> str:
    """Return the least and the largest share of the cycles that is saved on the default machine."""
    shares = [each.less(0) for each in found]
    return f"{min(shares):.0f} to {max(shares):.0f} %"


def interval(share: accuracy.Share) -> str:
    """Return the bounds of a share's interval of 95 %."""
    low, high = share.interval()
    return f"{100 * low:.1f} to {100 * high:.1f} %"


def sections() -> str:
    """Return the sections of docs/networks.md."""
    found, multiplied, shorter, larger = rows(), multiplication(), difference(), more_words()
    assert sum(each.memory >= 230 for each in found.values()) == FULL, (
        "networks_costs.md says how many"
    )
    facts = {f"{name}_words": str(each.words) for name, each in found.items()}
    facts |= {f"{name}_bytes": str(each.memory) for name, each in found.items()}
    facts |= {f"{name}_cycles": f"{each.cycles[0]:,.0f}" for name, each in found.items()}
    facts |= {f"{name}_slow": f"{each.cycles[1]:,.0f}" for name, each in found.items()}
    facts |= {f"{name}_right": each.right[0] for name, each in found.items()}
    return TEMPLATE.read_text(encoding="utf-8").format(
        **facts,
        interval=interval(measures.digits(0)[0]),
        pictures=str(measures.digits(0)[0].total),
        triangles=robustness.TRIANGLES,
        poses=robustness.POSES,
        sets=len(measures.SEEDS),
        mhz=ILLUSTRATIVE_CLOCK_HZ // 1_000_000,
        noise=NOISE,
        threshold=measures.TRAINED,
        robust=measures.ROBUST,
        side_by_side=side_by_side(),
        multiplication=savings(multiplied, "conservative, 8 for `MUL`"),
        difference=savings(shorter),
        halving=savings(halving()),
        more_words=savings(larger),
        multiplied_rest=span(multiplied[1:]),
        multiplied_most=f"{multiplied[0].less(0):.0f} % ({multiplied[0].less(1):.0f} %)",
        difference_most=f"{shorter[0].less(0):.0f} % ({shorter[0].less(1):.0f} %)",
        halved=f"{halving()[0].less(0):.0f} %",
        larger=span(larger),
        both=str(found["digits"].words + found["keypoints"].words),
        scale=f"{found['digits'].cycles[0] / found['correlate'].cycles[0]:.0f}",
        nonlinear=run_of("trajectory_nonlinear").column.words,
    )
