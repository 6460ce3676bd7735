"""What goes to standard output, and what to do when that is gone or full."""

from __future__ import annotations

import contextlib
import os
import sys

import click

from npchip.base.errors import InputError


def emit(text: str) -> None:
    """Write `text` to standard output. A reader that has gone away (``| head``) is no error.

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
    """Send what is still buffered to nowhere, so that Python does not complain when it exits."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
