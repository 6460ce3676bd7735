"""Compile kernels that have a name, and write what they cost into docs/kernels.md.

python -m examples.kernels_page
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from examples.measure import MACHINES, ROOT
from npchip.kernels import Compiled, compile_kernels, read_kernel

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

PAGE = ROOT / "docs" / "kernels.md"
TABLES = re.compile(r"(<!-- (alone|together) -->\n).*?(\n<!-- end -->)", re.DOTALL)

NAMED: dict[str, tuple[str, dict[str, int]]] = {
    "identity": ("0 0 0; 0 1 0; 0 0 0", {}),
    "from_south_east": ("0 0 0; 0 0 0; 0 0 1", {}),
    "binomial": ("1 2 1; 2 4 2; 1 2 1", {"shift": 4}),
    "binomial_5": (
        "1 4 6 4 1; 4 16 24 16 4; 6 24 36 24 6; 4 16 24 16 4; 1 4 6 4 1",
        {"shift": 8},
    ),
    "gauss_5": ("2 4 5 4 2; 4 9 12 9 4; 5 12 15 12 5; 4 9 12 9 4; 2 4 5 4 2", {"shift": 7}),
    "box": ("1 1 1; 1 1 1; 1 1 1", {"shift": 3}),
    "box_5": ("1 1 1 1 1; " * 4 + "1 1 1 1 1", {"shift": 5, "down": True}),
    "cross": ("0 1 0; 1 4 1; 0 1 0", {"shift": 3}),
    "sobel_x": ("-1 0 1; -2 0 2; -1 0 1", {"shift": 3, "add": 128}),
    "sobel_y": ("-1 -2 -1; 0 0 0; 1 2 1", {"shift": 3, "add": 128}),
    "prewitt_x": ("-1 0 1; -1 0 1; -1 0 1", {}),
    "prewitt_y": ("-1 -1 -1; 0 0 0; 1 1 1", {"wrap": True}),
    "scharr_x": ("-3 0 3; -10 0 10; -3 0 3", {"shift": 5, "add": 128}),
    "roberts": ("0 0 0; 0 1 0; 0 0 -1", {"add": 128}),
    "laplace": ("0 1 0; 1 -4 1; 0 1 0", {"add": 128}),
    "laplace_8": ("1 1 1; 1 -8 1; 1 1 1", {}),
    "log_5": ("0 0 -1 0 0; 0 -1 -2 -1 0; -1 -2 16 -2 -1; 0 -1 -2 -1 0; 0 0 -1 0 0", {}),
    "sharpen": ("0 -1 0; -1 5 -1; 0 -1 0", {}),
    "emboss": ("-2 -1 0; -1 1 1; 0 1 2", {}),
    "kirsch": ("5 5 5; -3 0 -3; -3 -3 -3", {}),
    "motion_5": ("1 0 0 0 0; 0 1 0 0 0; 0 0 2 0 0; 0 0 0 2 0; 0 0 0 0 2", {"shift": 3}),
}

TOGETHER = (
    ("sobel_x", "sobel_y"),
    ("binomial", "laplace"),
    ("prewitt_x", "prewitt_y", "box"),
    ("binomial", "binomial_5"),
    ("identity", "binomial", "laplace", "sobel_x"),
)
"""Kernels that are compiled to one program."""


def compiled(*names: str) -> Compiled:
    """Compile kernels by their names."""
    kernels = []
    for name in names:
        text, options = NAMED[name]
        kernels.append(read_kernel(text, name, **options))
    return compile_kernels(kernels, MACHINES)


def document(page: str) -> str:
    """Return the page with the tables as they are now."""
    tables = {"alone": _alone, "together": _together}
    return TABLES.sub(lambda found: f"{found[1]}{_table(tables[found[2]]())}{found[3]}", page)


def _alone() -> Iterator[Sequence[str]]:
    yield "kernel", "rows", "options", "words", *(f"cycles, {name}" for name in MACHINES), "plan"
    for name, (text, options) in NAMED.items():
        result = compiled(name)
        yield f"`{name}`", text, _options(options), *_costs(result), result.plan.name


def _together() -> Iterator[Sequence[str]]:
    yield "kernels", "words", "apart", *(f"cycles, {name}" for name in MACHINES), "apart, default"
    for names in TOGETHER:
        apart = [compiled(name) for name in names]
        words, *cycles = _costs(compiled(*names))
        yield (
            ", ".join(f"`{name}`" for name in names),
            words,
            str(sum(len(one.program.words) for one in apart)),
            *cycles,
            f"{sum(one.cycles['default'] for one in apart):,}",
        )


def _options(options: dict[str, int]) -> str:
    shown = {"shift": f"--divide {1 << options.get('shift', 0)}"}
    shown |= {"add": f"--add {options.get('add')}", "wrap": "--wrap", "down": "--down"}
    return " ".join(shown[name] for name in options)


def _costs(result: Compiled) -> tuple[str, ...]:
    return str(len(result.program.words)), *(f"{result.cycles[name]:,}" for name in MACHINES)


def _table(rows: Iterator[Sequence[str]]) -> str:
    head, *body = rows
    numbers = {number for number, cell in enumerate(body[0]) if re.fullmatch(r"[\d,]+", cell)}
    rule = ["--:" if number in numbers else "---" for number in range(len(head))]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (head, rule, *body))


if __name__ == "__main__":
    PAGE.write_text(document(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
