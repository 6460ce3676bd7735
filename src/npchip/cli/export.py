"""``npchip export``: a page that runs a program, as one file."""

from __future__ import annotations

from typing import Any

import click

from npchip.base.files import check_suffix, check_writable, write_text
from npchip.cli.options import bundled, path_option, quantity
from npchip.cli.output import emit
from npchip.cli.programs import load, program_options
from npchip.cli.running import clip_options, memory_option, open_clip


@click.command("export")
@click.argument("program", shell_complete=bundled("program"))
@path_option("-o", "--output", required=True, metavar="FILE.html", help="The page to write.")
@clip_options
@click.option("--title", metavar="TEXT", help="Title of the page.  [default: program and clip]")
@program_options
@memory_option
@click.option(
    "--max-cycles", callback=quantity, metavar="N", default="50M", help="Limit for each frame."
)
def command(**options: Any) -> None:
    """Write a page that runs PROGRAM: one file, to be opened from disk or put on a web space.

    The page shows the program at work on the clip of --frames, and on what its reader chooses:
    images, a video, a .npy file or the camera. It holds all that it needs and loads nothing; it
    has the program's instructions, but not the text of its source.

    \b
    Examples:
      npchip export trajectory -o trajectory.html --frames coin_slide
      npchip export edges -o edges.html --title "Edges, live"
    """
    from npchip.frames.memory import read_memory
    from npchip.run.checks import check_fit
    from npchip.studio.export import Clip, clip_name, export_page, title_of
    from npchip.studio.places import need_site

    output = options["output"]
    check_suffix(output, (".html", ".htm"), "NP636", what="a page is", example="page.html")
    check_writable(output)
    need_site()
    isa, machine, program = load(options["program"], options)
    check_fit(program, machine, isa)
    frames = open_clip(options, machine)
    clip = None if frames is None else Clip(clip_name(options["frames"]), frames)
    page = export_page(
        program,
        machine,
        isa,
        clip=clip,
        memory=[(at, read_memory(at, file, machine)) for at, file in options["memory"]],
        max_cycles=options["max_cycles"],
        title=options["title"] or title_of(program, clip),
    )
    write_text(output, page)
    emit(f"{output}: {len(page.encode()) / 1e3:,.0f} kB; open it in a browser\n")
