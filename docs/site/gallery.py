"""The gallery: every program of asm/ live, on the clip that docs/programs.md measures it on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from docs.site.order import listed
from docs.site.sources import ROOT
from examples.measure import PROGRAMS, case_of
from npchip import InputError, assemble, load_machine
from npchip.frames import open_frames
from npchip.frames.memory import read_memory
from npchip.isa import load_isa
from npchip.studio.export import Clip, export_page
from npchip.studio.places import need_site

if TYPE_CHECKING:
    from docs.site.sources import Sources

LIVE = "live"
"""Folder of the site that has the live pages, ``PROGRAM.html``."""
UNBUILT = "Nothing runs here: the studio's page was not built when this site was."
_GALLERY = """\
# Gallery

Every program that comes with npchip, with its source. {live} Their words, cycles, outputs and
constants stand in [one table](docs/programs.md).

{programs}
"""
_RUN = "They run in your browser: choose a file or the camera, and step through the program."
_PAGE = """\
# `{name}`

{summary}

{live}

`npchip run {name} --frames CLIP` runs it in a shell, and [the table of all
programs](docs/programs.md) has its words, cycles and outputs.

## Source

```asm
{source}
```
"""
_FRAME = """\
<iframe class="live" src="../{page}" title="{name}, live" loading="lazy"></iframe>
<p><a href="../{page}">On a page of its own</a></p>"""


def write(sources: Sources, words: dict[str, str]) -> None:
    """Write the page of the gallery, and one for each program.

    Args:
        sources: the folder of sources.
        words: what stands in the place of a live page, by the program's name, where there is none.
    """
    live = UNBUILT if UNBUILT in words.values() else _RUN
    programs = "\n".join(f"- [`{name}`](asm/{name}.s): {_summary(name)}" for name in PROGRAMS)
    pages = listed("", [f"gallery/{name}" for name in PROGRAMS], hidden=True)
    sources.add("gallery.md", _GALLERY.format(live=live, programs=programs) + pages, ROOT)
    for name in PROGRAMS:
        page = _PAGE.format(
            name=name,
            summary=_summary(name),
            live=words.get(name) or _FRAME.format(name=name, page=f"{LIVE}/{name}.html"),
            source=_source(name).read_text(encoding="utf-8").rstrip(),
        )
        sources.add(f"gallery/{name}.md", page, ROOT)


def export(folder: Path) -> dict[str, str]:
    """Write the live pages.

    Args:
        folder: the folder to write ``PROGRAM.html`` to.

    Returns:
        a sentence for each program that has no page: why not.
    """
    try:
        need_site()
    except InputError:
        return dict.fromkeys(PROGRAMS, UNBUILT)
    words = {}
    for name in PROGRAMS:
        page = _exported(_source(name))
        if page is None:
            words[name] = "The program needs a second camera, which one page cannot show."
        else:
            (folder / f"{name}.html").write_text(page, encoding="utf-8")
    return words


def _source(name: str) -> Path:
    return ROOT / "asm" / f"{name}.s"


def _summary(name: str) -> str:
    with _source(name).open(encoding="utf-8") as lines:
        return lines.readline().partition(" - ")[2].strip().replace("|", "\\|")


def _exported(path: Path) -> str | None:
    """Return the live page of a program; None for one that needs another chip."""
    run = case_of(path, "default").run
    if run.partner or run.frames is None:
        return None
    isa, machine = load_isa(), load_machine("default")
    program = assemble(path, machine=machine, defines=run.defines)
    frames = open_frames(path.parent / run.frames, machine.rows, machine.cols)
    return export_page(
        program,
        machine,
        isa,
        clip=Clip(Path(run.frames).stem, frames),
        memory=[(at, read_memory(at, path.parent / file, machine)) for at, file in run.memory],
        max_cycles=run.max_cycles,
        title=path.stem,
    )
