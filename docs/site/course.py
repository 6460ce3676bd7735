"""The pages of the course: what an exercise asks, and where it begins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from docs.site.order import listed
from docs.site.sources import ROOT
from npchip.course.exercise import load_course

if TYPE_CHECKING:
    from docs.site.sources import Sources
    from npchip.course.exercise import Exercise

_EXERCISES = ROOT / "src" / "npchip" / "course" / "exercises"
_INTRODUCTION = """\
# The course

{count} exercises, from one pixel to key points and budgets. `npchip learn` hands them out, checks
what you write and gives hints; [learning and teaching](docs/teaching.md) says how. The
[studio](docs/studio.md#lessons) has them too.
"""
_BEGIN = """
## Begin

`npchip learn start {name}` writes this page, the checks and the starter into the folder `{name}`;
`npchip learn check` says what holds. This is `{name}.s`:

```asm
{starter}
```
"""


def write(sources: Sources) -> None:
    """Write the page of the course, and one for each exercise."""
    names = {
        f"{number:02}-{each.name}": each
        for number, each in enumerate(load_course(_EXERCISES).exercises.values(), start=1)
    }
    introduction = _INTRODUCTION.format(count=len(names))
    sources.add("course.md", introduction + listed("", [f"course/{x}" for x in names]), ROOT)
    for name, exercise in names.items():
        sources.add(f"course/{name}.md", _page(exercise), exercise.folder)


def _page(exercise: Exercise) -> str:
    starter = (exercise.folder / "starter.s").read_text(encoding="utf-8").rstrip()
    return exercise.shown_page + _BEGIN.format(name=exercise.name, starter=starter)
