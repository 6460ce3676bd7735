"""The submissions of a class: every file and folder, with a word on those that are not run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from natsort import natsorted, ns

from npchip import bundle
from npchip.assembler.sources import read_source
from npchip.base.errors import InputError
from npchip.formats.files import ASSEMBLED
from npchip.testing.cases import cases_of
from npchip.testing.harness import (
    SUFFIX,
    Report,
    Selection,
    broken,
    included_files,
    read_golden,
    run_cases,
)
from npchip.testing.runner import Settings
from npchip.testing.suite import Suite, output_kinds


@dataclass(frozen=True)
class Submission:
    """A file or a folder that was handed in.

    Attributes:
        path: its path as given, or below a given folder.
        unrun: the reason why it is no program to run; empty if it is one.
        refused: the reason why it must not be read; empty if it may be.
    """

    path: Path
    unrun: str = ""
    refused: str = ""

    @property
    def runs(self) -> bool:
        """True if it is a program to run."""
        return not (self.unrun or self.refused)


def find_submissions(paths: Iterable[Path]) -> list[Submission]:
    """Return what was handed in: files, and folders with all below them.

    A submission is a file or a folder. Links are followed only within such a folder, and a file
    must not include another submission that lies beside it.

    Raises:
        InputError: NP275, there is no such file.
    """
    found: dict[Path, Submission] = {}
    for given in paths:
        path = bundle.find("program", given)
        if path.is_dir():
            handed_in = list(_below(path, path))
        elif path.exists() or path.is_symlink():
            handed_in = [_file(path, None, named=True)]
        else:
            hint = bundle.hint("program", given)
            raise InputError("NP275", f"{path}: no such file or folder", hint=hint)
        found |= {each.path: each for each in handed_in}
    return list(found.values())


def test_submission(
    suite: Suite, given: Submission, settings: Settings, selection: Selection
) -> Report:
    """Run the tests of a suite on a submission."""
    report = Report(given.path, unrun=given.unrun)
    if given.unrun:
        return report
    if given.refused:
        return broken(report, InputError("NP028", f"{given.path}: {given.refused}, not read"))
    try:
        golden = read_golden(suite.path)
    except InputError as error:
        return broken(report, error)
    run_cases(report, cases_of(suite, given.path), golden, settings, selection)
    return report


test_submission.__test__ = False  # type: ignore[attr-defined]


def _below(folder: Path, top: Path) -> Iterator[Submission]:
    """Yield what lies in a folder; the submissions of a class lie in the folder `top`."""
    try:
        entries = natsorted(sorted(folder.iterdir()), alg=ns.PATH)
    except OSError as error:
        yield Submission(folder, f"cannot be opened: {error.strerror or error}")
        return
    found = [each for entry in entries for each in _entry(entry, top)]
    if folder == top:
        found = [_refused_if_copied(each, folder) for each in found]
    else:
        if not any(each.path.suffix == SUFFIX for each in found):
            yield Submission(folder, f"a folder without a {SUFFIX} file" if found else "empty")
        if folder.parent == top:  # one submission, of several files
            found = _without_parts(found)
    yield from found


def _without_parts(found: list[Submission]) -> list[Submission]:
    parts = included_files(each.path for each in found if each.runs)
    return [
        Submission(each.path, "included by another file")
        if each.runs and each.path.resolve() in parts
        else each
        for each in found
    ]


def _refused_if_copied(given: Submission, folder: Path) -> Submission:
    """Refuse a file that includes another submission: a file beside it that has outputs."""
    if not given.runs or given.path.parent != folder:
        return given
    own = given.path.resolve()
    known, fresh = {own}, {own}
    while fresh:
        fresh = {path for path in included_files(fresh) if _own(path, folder)} - known
        known |= fresh
    for path in sorted(known - {own}):
        with suppress(InputError):
            if path.suffix == SUFFIX and output_kinds(read_source(path)):
                return Submission(given.path, refused=f"includes another submission, {path.name}")
    return given


def _entry(path: Path, top: Path) -> Iterator[Submission]:
    if path.is_dir() and not path.is_symlink() and not path.name.startswith("."):
        yield from _below(path, top)
    else:
        parts = path.relative_to(top).parts
        yield _file(path, top / parts[0] if len(parts) > 1 else None)


def _file(path: Path, folder: Path | None, *, named: bool = False) -> Submission:
    """Judge a path by its kind and name.

    Args:
        path: the file.
        folder: the folder that was handed in as a whole; None for a file by itself.
        named: the file was named itself, and may have any name.
    """
    if path.is_symlink() and not (folder and _own(path, folder)):
        return Submission(path, refused="a link that leads out of the submission")
    if path.name.startswith(".") and not named:
        return Submission(path, "hidden")
    if path.is_dir():
        return Submission(path, "a link to a folder")
    if not path.is_file():
        return Submission(path, "no file" if path.exists() else "a link that leads nowhere")
    if path.suffix == SUFFIX or named:
        return Submission(path)
    if path.suffix.lower() in ASSEMBLED:
        return Submission(path, f"assembled: hand in the {SUFFIX} source")
    return Submission(path, f"its name does not end in {SUFFIX}")


def _own(link: Path, folder: Path) -> bool:
    try:
        return link.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # a link to itself
        return False
