"""The test lines of a program: what its runs need, and what they say of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from npchip.assembler import AssemblyError, Diagnostic, assemble
from npchip.assembler.diagnostics import SourceError, Span
from npchip.base.errors import InputError
from npchip.isa import Isa
from npchip.language.places import place
from npchip.machine import Machine, load_machine
from npchip.program.model import Program
from npchip.studio.toolchain.results import result_of, stuck_in
from npchip.studio.toolchain.tables import Tables, table_for
from npchip.testing.cases import MACHINE_FILES, Case, cases_of, checked_suite
from npchip.testing.claims import Claim
from npchip.testing.evaluate import check_claim
from npchip.testing.golden import Entry, golden_path, load
from npchip.testing.judge import Finished, judge


class _Prepared(NamedTuple):
    """A case with what it runs; without a program, `refused` says why."""

    case: Case
    machine: Machine | None
    program: Program | None
    memory: list[dict[str, Any]]
    refused: str | None


class Checks:
    """The cases of a source.

    Args:
        path: the source; its machine files and its golden are read from beside it.
        isa: the instruction set.
        tables: what runs may have in the NPs' memory.

    Raises:
        NpchipError: the test lines, or the program for one of the runs, have mistakes.
    """

    def __init__(self, path: Path, isa: Isa, tables: Tables) -> None:
        self._isa = isa
        self._tables = tables
        self._programs: dict[Any, Program] = {}
        self._cases: list[_Prepared] = []
        mistakes: dict[Diagnostic, None] = {}
        for case in cases_of(checked_suite(path)):
            item = self._prepared(case)
            if item.program is not None:
                mistakes |= dict.fromkeys(_mistakes(case, item.program))
            self._cases.append(item)
        if mistakes:
            raise AssemblyError(mistakes)
        self._golden: dict[str, Entry] = load(golden_path(path))

    def _prepared(self, case: Case) -> _Prepared:
        run, folder, isa = case.run, case.suite.path.parent, self._isa
        is_file = case.machine.endswith(MACHINE_FILES)
        if is_file and not (folder / case.machine).is_file():
            missing = f"its machine file {case.machine} is not in the project"
            return _Prepared(case, None, None, [], missing)
        with _at(run.span):
            spec = folder / case.machine if is_file else case.machine
            machine = load_machine(spec, isa.timing_classes)
            key = (machine, *sorted(run.defines.items()))
            if key not in self._programs:
                self._programs[key] = assemble(case.program, machine, run.defines, isa)
        memory = [(at, file, table_for(self._tables, file, at, machine)) for at, file in run.memory]
        parts = [table.part(at) for at, _, table in memory if table]
        refused = _refused(case, [file for _, file, table in memory if not table])
        return _Prepared(case, machine, self._programs[key], parts, refused)

    def runs(self) -> list[dict[str, Any]]:
        """Return a ``TestRun`` for each case."""
        return [_run(item) for item in self._cases]

    def judge(self, run: str, machine: str, document: Mapping[str, Any]) -> list[dict[str, Any]]:
        """Return the ``Verdict`` list of a run.

        Raises:
            InputError: NP275 there is no such run; NP279 a run that has no frames wanted some.
        """
        found = [i for i in self._cases if (i.case.run.name, i.case.machine) == (run, machine)]
        if not found:
            raise InputError("NP275", f"the program has no run '{run}' on machine {machine}")
        case, of, program, _, refused = found[0]
        if of is None or program is None:
            raise InputError("NP275", f"run '{run}' cannot be judged: {refused}")
        without = case.run.frames is None and case.run.levels is None
        if without and document["status"] == "frames-exhausted":
            raise InputError(
                "NP279",
                f"{program.name} takes frames, but this run has none",
                hint=f"; run: {run} frames=clip.npy, or levels=0,128,255",
            )
        finished = Finished(
            result_of(document, program),
            program,
            of,
            partial(stuck_in, document, program, of, self._isa),
        )
        judgement = judge(case, finished, self._golden)
        verdicts = [
            {
                "run": run,
                "machine": machine,
                "claim": verdict.text,
                "place": place(verdict.span),
                "holds": verdict.holds,
                "found": verdict.shown,
            }
            for verdict in judgement.verdicts
        ]
        first = next((each for each in verdicts if not each["holds"]), None)
        if first and judgement.mistake:
            first["found"] = f"{first['found']}\nperhaps: {judgement.mistake}"
        return verdicts


@contextmanager
def _at(span: Span) -> Iterator[None]:
    """Give errors that are the run's its place."""
    try:
        yield
    except InputError as error:
        found = Diagnostic("error", error.code, error.message, span, suggestion=error.hint)
        raise AssemblyError([found]) from None


def _mistakes(case: Case, program: Program) -> list[Diagnostic]:
    found = []
    for claim in (*case.run.claims, *(mistake.claim for mistake in case.run.mistakes)):
        if isinstance(claim, Claim):
            try:
                check_claim(claim, program)
            except SourceError as error:
                found.append(error.diagnostic)
    return found


def _run(item: _Prepared) -> dict[str, Any]:
    case, run = item.case, item.case.run
    return {
        "name": run.name,
        "place": place(run.span),
        "frames": run.frames,
        "levels": None if run.levels is None else list(run.levels),
        "first": run.first,
        "fit": run.fit,
        "machine": case.machine,
        "defines": run.defines,
        "memory": item.memory,
        "maxCycles": run.max_cycles,
        "refused": item.refused,
    }


def _refused(case: Case, missing: Sequence[str]) -> str | None:
    """Return why the page cannot make a run; `missing` are files that it has not."""
    run = case.run
    if run.partner is not None:
        return f"it needs a partner camera, {run.partner}: run it with npchip test"
    if missing:
        return f"it needs the NPs' memory from {', '.join(missing)}: run it with npchip test"
    return None
