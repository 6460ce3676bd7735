"""``npchip export``: a page that runs a program, as one file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_suffix, check_writable, write_text
from npchip.cli.options import bundled, path_option, quantity
from npchip.cli.output import emit
from npchip.cli.programs import load, program_options
from npchip.cli.running import clip_options, given_memory, memory_option, open_clip

if TYPE_CHECKING:
    from npchip.machine import Machine


@click.command("export")
@click.argument("program", shell_complete=bundled("program"))
@path_option("-o", "--output", required=True, metavar="FILE.html", help="The page to write.")
@clip_options
@click.option("--title", metavar="TEXT", help="Title of the page.  [default: program and clip]")
@click.option(
    "--guide", metavar="ROWSxCOLS", help="Show where to hold something before the camera."
)
@program_options
@memory_option
@click.option(
    "--max-cycles", callback=quantity, metavar="N", default="50M", help="Limit for each frame."
)
def command(**options: Any) -> None:
    """Write a page that runs PROGRAM: one file, to be opened from disk or put on a web server.

    The page shows the program at work on the clip of --frames, and on what its reader chooses:
    images, a video, a .npy file or the camera. It holds all that it needs and loads nothing; it
    has the program's instructions, but not the text of its source.

    \b
    Examples:
      npchip export trajectory -o trajectory.html --frames coin_slide
      npchip export edges -o edges.html --title "Edges, live"
      npchip export digits -o digits.html --define DARK=1 --define SURE=200 --guide 56x48
    """
    from npchip.run.checks import check_fit
    from npchip.studio.export import Clip, clip_name, export_page, title_of
    from npchip.studio.places import need_site

    output = options["output"]
    check_suffix(output, (".html", ".htm"), "NP636", what="a page is", example="page.html")
    check_writable(output)
    need_site()
    isa, machine, program = load(options["program"], options)
    check_fit(program, machine, isa)
    guide = _guide(options["guide"], machine)
    frames = open_clip(options, machine)
    clip = None if frames is None else Clip(clip_name(options["frames"]), frames)
    page = export_page(
        program,
        machine,
        isa,
        clip=clip,
        memory=given_memory(options, machine),
        max_cycles=options["max_cycles"],
        title=options["title"] or title_of(program, clip),
        guide=guide,
    )
    write_text(output, page)
    emit(f"{output}: {len(page.encode()) / 1e3:,.0f} kB; open it in a browser\n")


def _guide(text: str | None, machine: Machine) -> tuple[int, int] | None:
    """Read ``--guide``: rows and columns of pixels that the machine has."""
    if text is None:
        return None
    found = re.fullmatch(r"([0-9]{1,4})x([0-9]{1,4})", text)
    rows, cols = (int(found[1]), int(found[2])) if found else (0, 0)
    if not (0 < rows <= machine.rows and 0 < cols <= machine.cols):
        raise InputError(
            "NP636",
            f"--guide {text}: expected rows x columns, up to {machine.rows}x{machine.cols}",
            hint="such as --guide 56x48",
        )
    return rows, cols
