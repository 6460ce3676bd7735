"""Making, reading and completing options."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.shell_completion import CompletionItem

from npchip.base.errors import InputError
from npchip.base.numbers import whole_number

if TYPE_CHECKING:
    from npchip.bundle import What

_F = TypeVar("_F", bound=Callable[..., Any])

_MULTIPLES = {"": 1, "k": 10**3, "K": 10**3, "M": 10**6, "G": 10**9}
_QUANTITY = re.compile(
    r"(\d[\d_]*(?:\.\d+)?(?:[eE]\+?\d{1,2})?)\s*([kKMG]?)(?:[hH][zZ])?", re.ASCII
)
_LARGEST = 10**15


def together(*options: Callable[[Any], Any]) -> Callable[[_F], _F]:
    """Combine several options into one decorator; the help shows them in this order."""

    def add(command: _F) -> _F:
        for option in reversed(options):
            command = option(command)
        return command

    return add


path_option = partial(click.option, type=click.Path(path_type=Path), metavar="FILE")
"""Make an option whose value is a path; arguments as for `click.option`."""


# ---- values


def quantity(_ctx: click.Context, option: click.Parameter, text: str | None) -> int | None:
    """Read a whole number from 1 to 10**15, such as ``10e6``, ``10M``, ``10 MHz`` or ``0x100``.

    Raises:
        InputError: NP240, the text is no such number.
    """
    if text is None:
        return None
    match = _QUANTITY.fullmatch(text.strip())
    number: Decimal | int
    if match:
        number = Decimal(match[1].replace("_", "")) * _MULTIPLES[match[2]]
    else:
        number = whole_number(text) or 0
    if not 1 <= number <= _LARGEST or number != int(number):
        raise InputError(
            "NP240",
            f"{option.opts[0]} {text}: expected a whole number from 1 to 10**15",
            hint="such as 10000000, 10e6 or 10M",
        )
    return int(number)


def definitions(
    _ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> dict[str, int]:
    """Read ``NAME=VALUE``; the value is a whole number, decimal, ``0x..`` or ``0b..``.

    Raises:
        InputError: NP241, a text has another form; NP245, a name is given twice.
    """
    values: dict[str, int] = {}
    for text in texts:
        name, _, digits = map(str.strip, text.partition("="))
        number = whole_number(digits)
        if not name or number is None:
            raise InputError(
                "NP241",
                f"{option.opts[0]} {text}: expected NAME=VALUE with a whole number",
                hint="such as --define THRESHOLD=24 or --define THRESHOLD=0x18",
            )
        if name in values:
            raise InputError("NP245", f"{option.opts[0]} {text}: {name} is given twice")
        values[name] = number
    return values


def memory_files(
    _ctx: click.Context, option: click.Parameter, texts: tuple[str, ...]
) -> list[tuple[int, Path]]:
    """Read ``ADDR=FILE.npy``; `npchip.frames.memory` reads the files.

    Raises:
        InputError: NP242, a text has another form.
    """
    pairs = []
    for text in texts:
        digits, _, file = text.partition("=")
        address = whole_number(digits)
        if not file or address is None or address < 0:
            raise InputError(
                "NP242",
                f"{option.opts[0]} {text}: expected ADDR=FILE.npy with an address from 0 on",
                hint="such as --memory 0xC0=weights.npy",
            )
        pairs.append((address, Path(file)))
    return pairs


class Whole(click.IntRange):
    """A whole number in ASCII digits."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number."""
        return super().convert(_in_ascii(self, value, param, ctx), param, ctx)


class Real(click.FloatRange):
    """A number in ASCII digits."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number."""
        return super().convert(_in_ascii(self, value, param, ctx), param, ctx)


def _in_ascii(
    kind: Whole | Real, value: Any, param: click.Parameter | None, ctx: click.Context | None
) -> Any:
    if isinstance(value, str) and not value.isascii():
        kind.fail(f"{value!r} is not written in the digits 0 to 9.", param, ctx)
    return value


# ---- completion


def files(_ctx: click.Context, _option: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Let the shell complete a file name."""
    return [CompletionItem(incomplete, type="file")]


def bundled(
    *kinds: What,
) -> Callable[[click.Context, click.Parameter, str], list[CompletionItem]]:
    """Return a completion of file names and of the names of bundled files."""

    def complete(
        ctx: click.Context, option: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        from npchip import bundle

        known = {
            name: item.summary for kind in kinds for name, item in bundle.bundled(kind).items()
        }
        names = [
            CompletionItem(name, help=summary)
            for name, summary in known.items()
            if name.startswith(incomplete)
        ]
        return names + files(ctx, option, incomplete)

    return complete


def machines(ctx: click.Context, option: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete the name of a shipped machine or a file, also after a comma."""
    from npchip.machine import BUILTIN

    listed, comma, last = incomplete.rpartition(",")
    names = [CompletionItem(f"{listed}{comma}{name}") for name in BUILTIN if name.startswith(last)]
    return names or files(ctx, option, incomplete)


def mnemonics(
    _ctx: click.Context, _option: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Complete a mnemonic; each has its instruction's title."""
    from npchip.isa import load_isa

    forms = {
        form.mnemonic: item.title
        for item in load_isa().instructions.values()
        for form in item.forms
    }
    return [
        CompletionItem(name, help=title)
        for name, title in forms.items()
        if name.startswith(incomplete.upper())
    ]
