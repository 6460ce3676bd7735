"""Writing to standard output, and checks before a long run."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_suffix

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from npchip.report.table import Clock

_MODULES = {"matplotlib": "Matplotlib", "pygls": "pygls", "scipy": "SciPy", "vcd": "pyvcd"}


def emit(text: str) -> None:
    """Write `text` to standard output. A closed pipe (``| head``) is no error.

    Raises:
        InputError: NP251, standard output cannot be written.
    """
    try:
        click.echo(text, nl=False)
    except BrokenPipeError:
        abandon_stdout()
    except OSError as error:
        abandon_stdout()
        raise InputError(
            "NP251", f"cannot write to standard output: {error.strerror or error}"
        ) from None


def abandon_stdout() -> None:
    """Discard buffered output, so that Python does not complain at exit."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def table_text(cells: Sequence[Sequence[str]]) -> str:
    """Return a table, drawn for a terminal or else in plain columns; the first row is its head."""
    if sys.stdout.isatty():
        from npchip.report.terminal import side_by_side

        return side_by_side(cells, shutil.get_terminal_size().columns)
    from npchip.base.columns import aligned

    return "".join(f"{line}\n" for line in aligned(cells))


def clock_of(options: dict[str, Any]) -> Clock:
    """Return the clock of ``--clock``, or the illustrative one."""
    from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ, Clock

    return Clock(options["clock"] or ILLUSTRATIVE_CLOCK_HZ, stated=options["clock"] is not None)


def need(module: str, code: str, what: str, extra: str) -> None:
    """Raise before long work where a module of an optional extra is not installed.

    Raises:
        InputError: `code`.
    """
    if module == "matplotlib":  # a notebook's backend may not be there, and only files are drawn
        os.environ["MPLBACKEND"] = "agg"
    if find_spec(module) is None:
        hint = f"pip install 'npchip[{extra}]' installs it"
        raise InputError(code, f"{what} needs {_MODULES[module]}", hint=hint)
    if module == "matplotlib":
        _check_settings(code, what)


def _check_settings(code: str, what: str) -> None:
    """Raise where Matplotlib cannot read the settings that it finds when it is imported."""
    try:
        import matplotlib as _  # noqa: F401, ICN001
    except Exception as error:  # noqa: BLE001 - whatever is in the file
        raise InputError(
            code,
            f"{what} needs Matplotlib, which cannot be used: {error}",
            hint="is a file matplotlibrc damaged, here or in Matplotlib's settings?",
        ) from None


def check_chart(path: Path, option: str, code: str, what: str, missing: str) -> None:
    """Raise before long work where a chart cannot be drawn.

    Raises:
        InputError: `code`, the name ends neither in .png nor in .svg; `missing`, Matplotlib is
            not installed.
    """
    example, suffixes = "cycles.png", (".png", ".svg")
    check_suffix(path, suffixes, code, what=what, example=example, option=f"{option} ")
    need("matplotlib", missing, option, "plot")
