"""``npchip test``: check programs against their expectations and goldens."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip import bundle
from npchip.base.errors import InputError
from npchip.base.files import check_writable, write_bytes
from npchip.cli.options import path_option
from npchip.cli.output import emit
from npchip.cli.programs import include_option, isa_option, load_isa_option, project_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip.testing.cases import Case
    from npchip.testing.harness import Report, Selection
    from npchip.testing.marks import Mark
    from npchip.testing.report import Paint
    from npchip.testing.runner import Settings
    from npchip.testing.suite import Suite


@click.command("test")
@click.argument(
    "paths",
    metavar="FILE|DIR...",
    nargs=-1,
    required=True,
    type=click.Path(path_type=Path),
)
@path_option(
    "--program",
    "programs",
    metavar="FILE|DIR",
    multiple=True,
    help="Judge another program by the tests of FILE; may be repeated.",
)
@click.option("--update", is_flag=True, help="Record the goldens that differ; not where CI is set.")
@click.option("--table", is_flag=True, help="Print a row for each submission, with its points.")
@path_option("--csv", help="Write these rows as CSV.")
@path_option("--junit", help="Write JUnit XML.")
@click.option("-k", "pattern", metavar="TEXT", help="Only runs with TEXT in file::run.")
@click.option("-x", "stop", is_flag=True, help="Stop after the first run that fails.")
@click.option(
    "--engine",
    metavar="NAME",
    default="auto",
    help="What executes the programs; results are the same.",
)
@include_option
@isa_option
def command(**options: Any) -> None:
    """Run programs as their ; run: lines say, and check their ; expect: lines.

    Of a folder, all .s files below it that have such lines are tested. Exits with 0; 1 if
    anything differs; 2 if something could not be tested.

    \b
    Examples:
      npchip test trajectory -k coin
      npchip test mine.s
      npchip test mine.s --update                       record what comes out
      npchip test exercise.s --program submissions/ --table     grade a class
    """
    _refuse_early(options)
    reports = []
    colours = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
    paint = _paint if colours else _plain
    progress = _Progress()
    marks: list[Mark] = []
    for report, width in _tested(options, progress, marks):
        from npchip.testing.report import report_text

        reports.append(report)
        progress.clear()
        shown = report.outcomes or report.problems or not options["pattern"]
        if shown and not options["table"]:
            emit(report_text(report, width, paint, brief=bool(options["programs"])))
        if options["stop"] and (report.count("failed") or report.count("error")):
            break
    _write_marks(options, marks)
    _finish(options, reports, paint)


def _refuse_early(options: dict[str, Any]) -> None:
    if options["update"]:
        from npchip.testing.harness import refuse_update_in_ci

        if options["programs"]:
            raise InputError("NP278", "--update records the test file's own program, no --program")
        refuse_update_in_ci()
        for path in options["paths"]:
            if bundle.find("program", path) != path:
                raise InputError(
                    "NP278",
                    f"--update does not change the bundled program {path}",
                    hint="npchip examples --copy DIR writes it where it may be changed",
                )
    if options["table"] or options["csv"]:
        if not options["programs"]:
            raise InputError("NP278", "--table and --csv grade submissions", hint="add --program")
        if options["stop"]:
            raise InputError("NP278", "--table and --csv need all checks, no -x")
    for file in (options["junit"], options["csv"]):
        if file:
            check_writable(file)


def _write_marks(options: dict[str, Any], marks: list[Mark]) -> None:
    from npchip.testing.marks import csv_text, table

    if options["table"]:
        emit(table(marks))
    if options["csv"]:
        write_bytes(options["csv"], csv_text(marks).encode())


def _tested(
    options: dict[str, Any], progress: _Progress, marks: list[Mark]
) -> Iterator[tuple[Report, int]]:
    """Yield each report when it is ready, and the width of the longest name."""
    from npchip.testing.harness import Selection, find_sources, included_files, test_source
    from npchip.testing.marks import mark
    from npchip.testing.report import longest
    from npchip.testing.runner import Settings

    first = next(iter(options["paths"]), None)
    settings = Settings(
        engine=options["engine"],
        isa=load_isa_option(options["isa_file"], first),
        include_paths=(*options["include_paths"], *project_of(first).include),
        update=options["update"],
    )
    selection = Selection(options["pattern"] or "", options["stop"], progress.show)
    if options["programs"]:
        for report, suite, width in _graded(options, settings, selection):
            marks.append(mark(report, suite, selection))
            yield report, width
        return
    sources = find_sources(options["paths"])
    width = longest([source for source, _ in sources])
    parts = included_files(source for source, _ in sources)
    for source, must in sources:
        report = test_source(source, settings, selection, must=must)
        if not (report.untested and source.resolve() in parts):
            yield report, width


def _graded(
    options: dict[str, Any], settings: Settings, selection: Selection
) -> Iterator[tuple[Report, Suite, int]]:
    from npchip.testing.cases import checked_suite
    from npchip.testing.harness import nothing_to_check
    from npchip.testing.report import longest
    from npchip.testing.submissions import find_submissions, test_submission

    if len(options["paths"]) > 1 or options["paths"][0].is_dir():
        raise InputError("NP278", "--program takes one test file", hint="name one FILE")
    suite = checked_suite(bundle.find("program", options["paths"][0]))
    if not suite.runs:
        raise InputError("NP275", nothing_to_check(suite.path).removesuffix(" [NP275]"))
    handed_in = find_submissions(options["programs"])
    width = longest([each.path for each in handed_in])
    for each in handed_in:
        yield test_submission(suite, each, settings, selection), suite, width


def _finish(options: dict[str, Any], reports: list[Report], paint: Paint) -> None:
    from npchip.testing.report import summary

    emit(summary(reports, paint))
    if options["junit"]:
        from npchip.testing.junit import junit

        write_bytes(options["junit"], junit(reports))
    if any(report.count("error") for report in reports):
        sys.exit(2)
    if any(report.count("failed") for report in reports):
        sys.exit(1)
    if not any(report.count("passed") for report in reports):
        chosen = f" with '{options['pattern']}' in its name" if options["pattern"] else ""
        raise InputError("NP275", f"nothing to check: no run{chosen}")


class _Progress:
    """Shows the name of the present run on a terminal, on a line that is erased later."""

    def __init__(self) -> None:
        self._wanted = sys.stderr.isatty() and sys.stdout.isatty()

    def show(self, case: Case) -> None:
        """Show the run that begins."""
        self._write(f"{case.program} {case.name} ...")

    def clear(self) -> None:
        """Erase the line."""
        self._write("")

    def _write(self, text: str) -> None:
        if self._wanted:
            room = shutil.get_terminal_size().columns - 1
            click.echo(f"\r\x1b[2K{text[:room]}", err=True, nl=False)


def _paint(text: str, colour: str) -> str:
    style: dict[str, Any] = {"bold": True} if colour == "bold" else {"fg": colour}
    return click.style(text, **style) if colour else text


def _plain(text: str, _colour: str) -> str:
    return text
