"""Exercises: folders with a page, a starter, checks, hints, a solution and wrong answers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from npchip import bundle
from npchip.base.errors import InputError
from npchip.base.files import read_bytes
from npchip.base.suggest import near_miss
from npchip.testing.suite import parse_suite

MAX_BYTES = 1 << 18
"""Most bytes of a file of an exercise that is shown or copied, but for its picture."""
FILES = ("page.md", "hints.md", "starter.s", "checks.s", "solution.s")
_FOLDER = re.compile(r"(?:(?P<number>\d{1,3})-)?(?P<name>[a-z][a-z0-9_-]{0,39})")
_NUMBERED = re.compile(r"(?P<number>[0-9]{1,3})(?:-(?P<name>.+))?")
_TEST_LINE = re.compile(r"\s*;+\s*(?:run|expect|mistake):")
_BETWEEN = re.compile(r"^---$", re.MULTILINE)  # two hints
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_DRAWN = re.compile(r"<!-- npchip run \w+\.s (?P<options>.*)--render picture\.png -->")
_TITLE = re.compile(r"# +(?P<title>\S.*)")


@dataclass(frozen=True)
class Exercise:
    """An exercise of a course.

    Attributes:
        folder: its folder, ``NUMBER-NAME`` or ``NAME``.
        name: its name.
    """

    folder: Path
    name: str

    @property
    def checks(self) -> Path:
        """The test file that the learner has."""
        return self.folder / "checks.s"

    @property
    def solution(self) -> Path:
        """The solution, whose test lines are those of `checks` and the hidden ones."""
        return self.folder / "solution.s"

    @property
    def page(self) -> str:
        """The text of its page, as it is written."""
        return _text(self.folder / "page.md")

    @property
    def shown_page(self) -> str:
        """Its page without the comments."""
        return _COMMENT.sub("", self.page).rstrip() + "\n"

    @property
    def title(self) -> str:
        """The heading of its page."""
        found = _TITLE.match(self.page)
        return found["title"].strip() if found else self.name

    @property
    def hints(self) -> list[str]:
        """Its hints, from the first push to nearly the solution."""
        return [step.strip() for step in _BETWEEN.split(_text(self.folder / "hints.md"))]

    @property
    def wrong(self) -> list[Path]:
        """Typical wrong answers; the first line of each says which mistake must be named."""
        return sorted((self.folder / "wrong").glob("*.s"))

    @property
    def drawn(self) -> tuple[str, ...]:
        """Options of `npchip run` that its picture was drawn with; empty if its page has none.

        Files among them lie in its folder.
        """
        found = _DRAWN.search(self.page)
        return tuple(found["options"].split()) if found else ()

    @property
    def is_drawn(self) -> bool:
        """True if a comment of its page has the command that draws its picture."""
        return _DRAWN.search(self.page) is not None

    @property
    def clip(self) -> str | None:
        """The clip of its picture; if npchip has it not, that of a shown run; None without."""
        runs = parse_suite(_text(self.checks), self.checks).runs
        drawn = (clip for at, clip in pairwise(self.drawn) if at == "--frames")
        known = bundle.bundled("clip")
        return next(
            (each for each in (*drawn, *(run.frames for run in runs)) if each in known), None
        )

    @property
    def unrepeated(self) -> list[str]:
        """Test lines of the shown checks that are not among the hidden ones."""
        shown, hidden = (_text(path).splitlines() for path in (self.checks, self.solution))
        return [line for line in shown if _TEST_LINE.match(line) and line not in hidden]

    def shown_solution(self) -> str:
        """Return the solution without the hidden checks."""
        lines = _text(self.solution).splitlines(keepends=True)
        return "".join(line for line in lines if not _TEST_LINE.match(line))

    def handed_out(self) -> dict[str, bytes]:
        """Return what a learner gets, by the file's name there.

        These are the page without its comments, picture, starter, checks, and what the checks and
        the picture are run on.
        """
        starter = f"{self.name}.s"
        names = {"starter.s": starter, "checks.s": "checks.s"}
        names |= {path.name: path.name for path in sorted(self.folder.glob("*.png"))}
        names |= {path.name: path.name for path in sorted(self.folder.glob("*.yaml"))}
        names |= {name: name for name in self.drawn if (self.folder / name).is_file()}
        files = {names[each]: _bytes(self.folder / each, 8 * MAX_BYTES) for each in names}
        return files | {"page.md": self.shown_page.encode()}


@dataclass(frozen=True)
class Course:
    """A folder of exercises, in the order of their names."""

    folder: Path
    exercises: dict[str, Exercise]

    def find(self, name: str) -> Exercise | None:
        """Return an exercise by its name, its number, or both as in ``03-threshold``."""
        matched = _NUMBERED.fullmatch(name)
        if matched is None:
            return self.exercises.get(name)
        at = int(matched["number"]) - 1
        found = [*self.exercises.values()][at] if 0 <= at < len(self.exercises) else None
        return found if found and matched["name"] in {None, found.name} else None

    def need(self, name: str) -> Exercise:
        """Return an exercise by its name or number.

        Raises:
            InputError: NP661, there is none.
        """
        found = self.find(name)
        if found is None:
            hint = self.near(name) or "npchip learn lists them"
            raise InputError("NP661", f"the course has no exercise '{name[:80]}'", hint=hint)
        return found

    def near(self, name: str) -> str | None:
        """Return a hint that names the exercise whose name is near; None if none is."""
        near = near_miss(name[:80], self.exercises)
        return f"did you mean {near}?" if near else None


def load_course(folder: Path | None = None) -> Course:
    """Return the course in a folder, the bundled one by default.

    Raises:
        InputError: NP660, the folder is none, holds no exercise, or one without its files.
    """
    top = bundle.course() if folder is None else folder
    found = {each.name: each for each in _exercises(top)}
    if not found:
        hint = "a folder for each exercise: 01-name with page.md, checks.s and so on"
        raise InputError("NP660", f"{top}: no exercises", hint=hint)
    return Course(top, found)


def load_exercise(folder: Path) -> Exercise:
    """Return the exercise in a folder.

    Raises:
        InputError: NP660, the name does not fit, or a file is missing.
    """
    matched = _FOLDER.fullmatch(folder.resolve().name)
    if matched is None:
        hint = "a name has small letters, digits, - and _; a number and - may stand before it"
        raise InputError("NP660", f"{folder}: no name of an exercise, such as 07-halo", hint=hint)
    for name in FILES:
        if not (folder / name).is_file():
            raise InputError("NP660", f"{folder}: this exercise has no {name}")
    return Exercise(folder, matched["name"])


def _exercises(top: Path) -> Iterator[Exercise]:
    try:
        folders = sorted(path for path in top.iterdir() if path.is_dir())
    except OSError as error:
        raise InputError("NP660", f"cannot read {top}: {error.strerror or error}") from None
    for path in folders:
        if _FOLDER.fullmatch(path.name) and any((path / name).exists() for name in FILES):
            yield load_exercise(path)


def _text(path: Path) -> str:
    try:
        return _bytes(path, MAX_BYTES).decode()
    except UnicodeDecodeError as error:
        raise InputError("NP660", f"{path}: not UTF-8 text at byte {error.start}") from None


def _bytes(path: Path, most: int) -> bytes:
    try:
        return read_bytes(path, most)
    except OSError as error:
        raise InputError("NP660", f"cannot read {path}: {error.strerror or error}") from None
