"""``npchip debug``: debug a program on a screen or from a script."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.cli.options import bundled, path_option, quantity
from npchip.cli.output import emit
from npchip.cli.programs import load, program_options
from npchip.cli.running import clip_options, given_memory, memory_option, open_clip, warn_of_frames

if TYPE_CHECKING:
    from npchip.debugger.session import Debugger


@click.command("debug")
@click.argument("program", shell_complete=bundled("program"))
@clip_options
@program_options
@memory_option
@click.option(
    "--max-cycles",
    callback=quantity,
    metavar="N",
    default="1M",
    help="Limit for each frame.",
)
@click.option(
    "--script",
    type=click.Path(path_type=Path, allow_dash=True),
    metavar="FILE",
    help="Execute commands from a file (- for standard input), without a screen.",
)
@path_option(
    "--breakpoints",
    help="Where breakpoints are kept; a script only loads them.  "
    "[default: PROGRAM.breakpoints.yaml; none for a script]",
)
def command(**options: Any) -> None:
    """Debug PROGRAM: breakpoints, conditions, steps forward and backward.

    On the screen ? shows the keys. Breakpoints are kept beside the program. A script has a command
    a line; exits with 1 if an expectation fails, with 2 for a bad line.

    \b
    Examples:
      npchip debug keypoints --frames shapes_photo
      npchip debug trajectory --frames clip.npy --script check.dbg
    """
    if options["script"] is None:
        sys.exit(_screen(options))
    sys.exit(_script(options))


def _session(options: dict[str, Any]) -> Debugger:
    from npchip.debugger.session import Debugger

    isa, machine, program = load(options["program"], options)
    memory = given_memory(options, machine)
    frames = open_clip(options, machine)
    limit = options["max_cycles"]
    debugger = Debugger(program, frames, machine, isa, memory=memory, max_cycles=limit)
    warn_of_frames(debugger.chip, options)
    return debugger


def _script(options: dict[str, Any]) -> int:
    from npchip.debugger.script import read_script, run_script
    from npchip.debugger.store import load as load_breakpoints

    name, lines = read_script(options["script"])
    debugger = _session(options)
    if options["breakpoints"]:
        for message in load_breakpoints(debugger, options["breakpoints"]):
            click.echo(f"warning: {message}", err=True)
    failures = run_script(debugger, lines, name, lambda text: emit(text + "\n"))
    for failure in failures:
        click.echo(failure, err=True)
    return 1 if failures else 0


def _screen(options: dict[str, Any]) -> int:
    from npchip.debugger import store

    try:
        from npchip.debugger.screen.app import DebugApp
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "textual":
            raise
        raise InputError(
            "NP356",
            "the screen of the debugger needs Textual, which is not installed",
            hint='pip install "npchip[debug]"; --script needs no screen',
        ) from None
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise InputError("NP357", "the debugger needs a terminal", hint="--script FILE needs none")
    debugger = _session(options)
    path = options["breakpoints"] or store.beside(options["program"])
    messages = [f"{path}: no breakpoints yet"] if options["breakpoints"] else []
    if path.exists():
        messages = store.load(debugger, path)
    app = DebugApp(debugger, path, messages)
    app.run()
    if app.fault is not None:
        raise getattr(app.fault, "error", app.fault)  # what a worker has met is wrapped
    return app.return_code or 0
