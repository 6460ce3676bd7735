"""``npchip kernel``: compile convolution kernels to a program."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_suffix, check_writable, write_text
from npchip.cli.options import path_option
from npchip.cli.output import emit

if TYPE_CHECKING:
    from npchip.kernels import Kernel


@click.command("kernel", context_settings={"ignore_unknown_options": True})  # "-1 0 1" is none
@click.argument("kernels", metavar="'ROW; ROW; ROW'...", nargs=-1, required=True)
@click.option("--name", "names", multiple=True, metavar="N", help="Its output.  [default: k1, ...]")
@click.option(
    "--divide", type=int, multiple=True, metavar="2^N", help="Divide the sum; a power of two."
)
@click.option(
    "--add", type=int, multiple=True, metavar="N", help="Add to the quotient: -255 to 255."
)
@click.option("--wrap", is_flag=True, help="Keep the lowest 8 bits; else limit to 0 to 255.")
@click.option("--down", is_flag=True, help="Round down; else to the nearest, halves up.")
@path_option("-o", "--output", metavar="FILE.s", help="Write the program; else print it.")
@click.option("--explain", is_flag=True, help="Print what is shared, not the program.")
def command(**options: Any) -> None:
    """Compile convolution kernels, 3 x 3 or 5 x 5, to one program in assembly.

    A kernel is rows of whole numbers, separated by ';'. It lies on the picture as you write it (a
    correlation); pixels outside the frame are 0. Several kernels share their sums, and each has an
    output of its own. An option given once holds for all of them; given once for each, it is
    theirs, in order.

    A sum needs 8 or 16 bits, which its range decides; one that 16 bits do not hold is refused. A
    program that does not fit the ROM says by how many words.

    \b
    Examples:
      npchip kernel '1 2 1; 2 4 2; 1 2 1' --divide 16 --name smooth -o smooth.s
      npchip kernel --divide 8 --add 128 --name x --name y --explain \\
          '-1 0 1; -2 0 2; -1 0 1' '-1 -2 -1; 0 0 0; 1 2 1'
      npchip run smooth.s --frames coin_slide
    """
    from npchip.kernels import compile_kernels
    from npchip.kernels.report import report

    output = options["output"]
    if output is not None:
        check_suffix(output, (".s",), "NP535", what="programs are", example="smooth.s")
        check_writable(output)
    compiled = compile_kernels(_kernels(options))
    if output is not None:
        write_text(output, compiled.text)
    if output is None and not options["explain"]:
        emit(compiled.text)
    else:
        emit(report(compiled))


def _kernels(options: dict[str, Any]) -> list[Kernel]:
    """Read the kernels, each with its options."""
    from npchip.kernels import read_kernel, shift_of

    texts = options["kernels"]
    for text in texts:
        if text.startswith("-") and (text[1:2] == "-" or text[1:2].isalpha()):
            raise click.NoSuchOption(text)
    default = tuple(f"k{number}" for number in range(1, len(texts) + 1))
    names = _each(options, "names", "--name", default)
    if len(options["names"]) == 1 and len(texts) > 1:
        names = tuple(f"{names[0]}{number}" for number in range(1, len(texts) + 1))
    divisors = _each(options, "divide", "--divide", (1,) * len(texts))
    added = _each(options, "add", "--add", (0,) * len(texts))
    return [
        read_kernel(
            text, name, shift=shift_of(divisor), add=add, wrap=options["wrap"], down=options["down"]
        )
        for text, name, divisor, add in zip(texts, names, divisors, added, strict=True)
    ]


def _each(
    options: dict[str, Any], key: str, option: str, default: tuple[Any, ...]
) -> tuple[Any, ...]:
    given: tuple[Any, ...] = options[key] or default
    if len(given) not in {1, len(default)}:
        raise InputError(
            "NP534",
            f"{option} is given {len(given)} times for {len(default)} kernels",
            hint="give it once for all, or once for each",
        )
    return given * len(default) if len(given) < len(default) else given
