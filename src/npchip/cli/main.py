"""``npchip``: the table of commands, loaded on use, and one place where every error ends."""

from __future__ import annotations

import gc
import importlib
import io
import os
import sys
from typing import Any, NamedTuple, NoReturn

import click
from click.shell_completion import CompletionItem

from npchip.base.errors import NpchipError
from npchip.base.suggest import near_miss
from npchip.cli.interrupts import is_interrupt, keep_interrupts
from npchip.cli.output import abandon_stdout

EXIT_INPUT = 2
EXIT_INTERNAL = 70
"""A fault in npchip itself (``EX_SOFTWARE``), so that no script takes it for the user's."""
EXIT_INTERRUPTED = 130


class Entry(NamedTuple):
    """A command: the section of the help it stands in, its module's name, what it does."""

    section: str
    module: str
    summary: str


COMMANDS: dict[str, Entry] = {
    "run": Entry("Run", "run", "Run a program on a clip: outputs, cycles of each frame."),
    "asm": Entry("Write", "asm", "Check a source, list it, write it as a file."),
    "disasm": Entry("Write", "disasm", "Turn an assembled program back into source."),
    "test": Entry("Check", "test", "Expectations and goldens of programs; grade a class."),
    "compare": Entry("Check", "compare", "Programs or machines side by side: words, cycles."),
    "debug": Entry("Look in", "debug", "Stop, look, step back; on a screen or from a script."),
    "profile": Entry("Look in", "profile", "Where the cycles go; what a run has covered."),
    "trace": Entry("Look in", "trace", "What every instruction does in chosen NPs; VCD."),
    "fuse": Entry("Vision", "fuse", "Two cameras: positions in space, table 2.1."),
    "orient": Entry("Vision", "orient", "Where a drone is, from the picture of a triangle."),
    "scene": Entry("Make", "scene", "Draw a synthetic clip, with the truth beside it."),
    "isa": Entry("Look up", "isa", "The instruction set, or one instruction's page."),
    "machine": Entry("Look up", "machine", "The machines: array, timing, sensor."),
    "completion": Entry("Look up", "completion", "What makes your shell complete npchip."),
}


class CommandLine(click.Group):
    """A group that imports a command's module only when that command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Names in the order of `COMMANDS`."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Import the command's module and return its ``command``."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"npchip.cli.{COMMANDS[cmd_name].module}")
        command: click.Command = module.command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Suggest a near miss; click's own search knows only commands already imported."""
        name = args[0]
        if name not in COMMANDS and not name.startswith("-") and not ctx.resilient_parsing:
            near = near_miss(name, COMMANDS)
            hint = f"Did you mean {near!r}?" if near else f"Commands: {', '.join(COMMANDS)}."
            ctx.fail(f"No such command {name!r}. {hint}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the commands grouped by task, without importing them."""
        sections = [entry.section for entry in COMMANDS.values()]
        shown = [
            "" if section == before else section
            for section, before in zip(sections, ["", *sections], strict=False)
        ]
        left, right = max(map(len, sections)), max(map(len, COMMANDS))
        with formatter.section("Commands"):
            formatter.write_dl(
                [
                    (f"{section:<{left}}  {name:<{right}}", entry.summary)
                    for section, (name, entry) in zip(shown, COMMANDS.items(), strict=True)
                ]
            )

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands; the epilog names the two options, so that all fits one screen."""
        self.format_commands(ctx, formatter)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Commands and what they do, without importing them."""
        if incomplete.startswith("-"):
            return click.Command.shell_complete(self, ctx, incomplete)
        return [
            CompletionItem(name, help=entry.summary)
            for name, entry in COMMANDS.items()
            if name.startswith(incomplete)
        ]

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; a reader that has gone away is no error (click would exit with 1)."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            abandon_stdout()
            return 0

    def main(self, *args: Any, **extra: Any) -> NoReturn:
        """Run the command line and exit; nothing but ``SystemExit`` leaves this function."""
        sys.exit(self._exit_code(*args, **extra))

    def _exit_code(self, *args: Any, **extra: Any) -> int:
        try:
            code = super().main(*args, **{**extra, "standalone_mode": False})
            sys.stdout.flush()
        except click.ClickException as error:
            error.show()
            return error.exit_code
        except NpchipError as error:
            click.echo(error, err=True)
            return error.exit_code
        except (click.Abort, KeyboardInterrupt):
            return _interrupted()
        except OSError as error:
            abandon_stdout()
            place = f"{error.filename}: " if error.filename else ""
            click.echo(f"error: {place}{error.strerror or error} [NP252]", err=True)
            return EXIT_INPUT
        except Exception as error:  # a traceback never reaches a user
            if is_interrupt(error):
                return _interrupted()
            if os.environ.get("NPCHIP_TRACEBACK"):
                raise
            click.echo(
                f"internal error: {type(error).__name__}: {error} [NP259]\n"
                "  hint: this is a fault in npchip; please report it with the traceback that"
                " NPCHIP_TRACEBACK=1 shows",
                err=True,
            )
            return EXIT_INTERNAL
        return code if isinstance(code, int) else 0


def _interrupted() -> int:
    click.echo("interrupted", err=True)
    return EXIT_INTERRUPTED


def _print_version(ctx: click.Context, _option: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from npchip import __version__

        click.echo(f"npchip {__version__}")
        ctx.exit()


@click.group(
    cls=CommandLine,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="npchip COMMAND --help has examples; npchip --version shows the version.",
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version and exit.",
)
def cli() -> None:
    """Emulate a vision chip of 8 x 10 neighborhood processors, cycle by cycle.

    \b
    Try: npchip run asm/trajectory.s --frames examples/clips/coin_slide.npy
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped


def main() -> NoReturn:
    """Entry point of the console script."""
    keep_interrupts()
    gc.set_threshold(100_000)  # what is made while starting stays: looking through it costs time
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a file name need not fit the locale
            stream.reconfigure(errors="backslashreplace")
    try:
        cli.main(prog_name="npchip")
    finally:
        gc.freeze()  # what is left goes with the process: looking through it costs time too
