"""``npchip``: the table of commands, which are loaded on use, and the handling of all errors."""

from __future__ import annotations

import gc
import importlib
import io
import os
import sys
from typing import Any, NoReturn

import click
from click.shell_completion import CompletionItem

from npchip.base.errors import NpchipError
from npchip.base.files import guarded
from npchip.base.suggest import near_miss
from npchip.cli import interrupts
from npchip.cli.output import abandon_stdout

EXIT_INPUT = 2
EXIT_INTERNAL = 70
"""Exit code for a fault in npchip itself (``EX_SOFTWARE``)."""


COMMANDS: dict[str, tuple[str, str]] = {
    "run": ("Run", "Run a program on a clip: outputs, cycles a frame."),
    "learn": ("Run", "Take the course: exercises, checks, hints, solutions."),
    "studio": ("Run", "Write, run and step programs in a browser; camera."),
    "sweep": ("Run", "Run many cases on all cores or a cluster; one table."),
    "asm": ("Write", "Assemble a source: check it, list it, write it."),
    "disasm": ("Write", "Turn an assembled program back into source."),
    "kernel": ("Write", "Compile convolution kernels to a program in assembly."),
    "lsp": ("Write", "Serve an editor: mistakes, cards, names, layout."),
    "dap": ("Write", "Serve an editor's debugger: stop, look, step back."),
    "test": ("Check", "Test programs against expectations; grade a class."),
    "compare": ("Check", "Compare programs or machines: words, cycles."),
    "debug": ("Inspect", "Stop, look, step back; on a screen or from a script."),
    "profile": ("Inspect", "Show where the cycles go, and what a run covers."),
    "trace": ("Inspect", "Log each instruction in chosen NPs; waves (VCD)."),
    "fuse": ("Vision", "Find positions in space from two cameras."),
    "orient": ("Vision", "Find a drone's position from a picture of a triangle."),
    "network": ("Vision", "Train a network, and measure how often it is right."),
    "scene": ("Make", "Draw a synthetic clip, with the truth beside it."),
    "export": ("Make", "Write a page that runs a program, without a server."),
    "isa": ("Look up", "Show the instruction set, or explain an instruction."),
    "machine": ("Look up", "Show the machines: array, timing, sensor."),
    "examples": ("Look up", "List or copy the programs and clips of npchip."),
    "completion": ("Look up", "Print a script to complete npchip in your shell."),
}
"""Section of the help and summary of each command; its module has the command's name."""

PAIRS = {
    ("asm", "disasm"): "Assemble a source: check, list, write; and back.",
    ("lsp", "dap"): "Serve an editor: mistakes, names, layout; debugger.",
    ("fuse", "orient"): "Find positions by two cameras; a drone's position.",
    ("isa", "machine"): "Show instructions; machines: array, timing, sensor.",
}
"""Commands of one section that share a line of the help, which has to fit one screen."""


def with_help(command: click.Command) -> click.Command:
    """Return a command with its help, which ``-OO`` drops."""
    if sys.flags.optimize > 1:
        from npchip.cli.docstrings import restore_help

        restore_help(command)
    return command


class CommandLine(click.Group):
    """A group that imports the module of a command only when it is needed."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Return the names in the order of `COMMANDS`."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Import the command's module and return its ``command``."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"npchip.cli.{cmd_name}")
        return with_help(module.command)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; suggest a similar name for an unknown one."""
        name = args[0]
        if name not in COMMANDS and not name.startswith("-") and not ctx.resilient_parsing:
            near = near_miss(name, COMMANDS)
            hint = f"Did you mean {near!r}?" if near else f"Commands: {', '.join(COMMANDS)}."
            ctx.fail(f"No such command {name!r}. {hint}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the commands grouped by section, without importing them."""
        lines = [
            next(((pair, text) for pair, text in PAIRS.items() if name in pair), ((name,), summary))
            for name, (_, summary) in COMMANDS.items()
        ]
        left = max(len(section) for section, _ in COMMANDS.values())
        rows = []
        before = ""
        for names, summary in dict(lines).items():
            section = COMMANDS[names[0]][0]
            shown = "" if section == before else section
            rows.append((f"{shown:<{left}}  {', '.join(names)}", summary))
            before = section
        with formatter.indentation():  # a heading or an empty line would be too much for a screen
            formatter.write_dl(rows)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands only; the epilog names the two options."""
        self.format_commands(ctx, formatter)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Complete commands with their summaries, without importing them."""
        if incomplete.startswith("-"):
            return click.Command.shell_complete(self, ctx, incomplete)
        return [
            CompletionItem(name, help=summary)
            for name, (_, summary) in COMMANDS.items()
            if name.startswith(incomplete)
        ]

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; a closed pipe is no error (click would exit with 1)."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            abandon_stdout()
            return 0

    def main(self, *args: Any, **extra: Any) -> NoReturn:
        """Run the command line and exit; raise nothing but ``SystemExit``."""
        sys.exit(self._exit_code(*args, **extra))

    def _exit_code(self, *args: Any, **extra: Any) -> int:
        try:
            with interrupts.Raising(), guarded():
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
        except MemoryError as error:
            click.echo(
                f"error: no memory is left{f': {error}' if str(error) else ''} [NP258]\n"
                "  hint: the process needs more; `ulimit -v` shows its limit",
                err=True,
            )
            return EXIT_INPUT
        except UnicodeEncodeError as error:
            if error.encoding == "utf-8":
                return _internal(error)
            name = error.object[:100].encode("ascii", "backslashreplace").decode()
            click.echo(
                f"error: {name}: no name of a file in this locale ({error.encoding}) [NP252]\n"
                "  hint: LC_ALL=C.UTF-8 in the environment allows all names",
                err=True,
            )
            return EXIT_INPUT
        except ImportError as error:
            return _interrupted() if interrupts.is_interrupt(error) else _not_loaded(error)
        except Exception as error:  # noqa: BLE001 - a traceback never reaches a user
            return _interrupted() if interrupts.is_interrupt(error) else _internal(error)
        return interrupts.exit_code() or (code if isinstance(code, int) else 0)


def _internal(error: Exception) -> int:
    if os.environ.get("NPCHIP_TRACEBACK"):
        raise error
    click.echo(
        f"internal error: {type(error).__name__}: {error} [NP259]\n"
        "  hint: this is a fault in npchip; please report it with the traceback that"
        " NPCHIP_TRACEBACK=1 shows",
        err=True,
    )
    return EXIT_INTERNAL


def _not_loaded(error: ImportError) -> int:
    if (error.name or "").startswith("npchip"):
        return _internal(error)
    said = " ".join(str(error).split())
    click.echo(
        f"error: a library cannot be loaded: {said[-200:]} [NP258]\n"
        "  hint: install npchip again, or allow more memory if `ulimit -v` limits it",
        err=True,
    )
    return EXIT_INPUT


def _interrupted() -> int:
    click.echo("interrupted", err=True)
    return interrupts.exit_code() or 130


def _print_version(ctx: click.Context, _option: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from npchip import __version__

        click.echo(f"npchip {__version__}")
        ctx.exit()


@click.group(
    cls=CommandLine,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
    epilog="Try: npchip run trajectory --frames coin_slide, COMMAND --help, --version.",
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
    """Emulate a vision chip of 8 x 10 neighborhood processors, cycle by cycle."""


def _open_streams() -> None:
    """Open streams that are closed, so that no file takes their place."""
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest free number, which is this one
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


class _Messages(io.FileIO):
    """Standard error; what cannot be said there (a full disk) changes nothing else."""

    def write(self, data: Any, /) -> int:
        try:
            return super().write(data) or 0
        except OSError:
            return len(data)


def main() -> NoReturn:
    """Run npchip from the console."""
    interrupts.keep_interrupts()
    _open_streams()
    with_help(cli)
    messages = io.BufferedWriter(_Messages(2, "w", closefd=False))
    sys.stderr = io.TextIOWrapper(messages, sys.stderr.encoding, line_buffering=True)
    gc.set_threshold(100_000)  # objects made at start-up stay, so searching them is wasted time
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a file name need not fit the locale
            stream.reconfigure(errors="backslashreplace")
    try:
        cli.main(prog_name="npchip")
    except SystemExit as end:
        interrupts.leave_with(end.code)
        raise
    finally:
        gc.freeze()  # the process ends, so a last search is wasted time too
