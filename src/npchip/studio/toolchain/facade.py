"""The compiler's methods: JSON in, JSON out."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from npchip.assembler import assemble
from npchip.assembler.definitions import Definition
from npchip.base.errors import InputError, NpchipError
from npchip.debugger.language import CommandError
from npchip.debugger.names import Names
from npchip.formats.module import Memory, run_form, to_module, with_stepping
from npchip.isa import load_isa
from npchip.language.places import diagnostic, diagnostics
from npchip.machine import Machine
from npchip.run.checks import check_fit
from npchip.studio.toolchain.checks import Checks
from npchip.studio.toolchain.conditions import condition_tree, quantity_of
from npchip.studio.toolchain.described import Assembled, bounds, described
from npchip.studio.toolchain.language import language
from npchip.studio.toolchain.project import Folder, machine_of
from npchip.studio.toolchain.tables import Tables, bound

Json = dict[str, Any]


class Answer(NamedTuple):
    """The answer to a call.

    Attributes:
        text: JSON: ``{"value": ...}``, or ``{"error": message, "forgotten": false}``.
        module: the module that belongs to it.
    """

    text: str
    module: bytes | None


class ForgottenError(InputError):
    """The program that a question is about is not the one that was compiled last."""


class _Run(NamedTuple):
    """The run form of a program, to which the stepping form is added when it is asked for."""

    request: Json
    blobs: Sequence[bytes]
    made: Assembled
    module: bytes


class Toolchain:
    """The compiler. It remembers the program that was compiled last, and its test lines.

    Args:
        folder: a folder of its own, in which projects lie while they are read.
        tables: what programs and the runs of test lines may have in the NPs' memory.
    """

    def __init__(self, folder: Path, tables: Tables | None = None) -> None:
        self._folder = Folder(folder)
        self._tables = tables or {}
        self._isa = load_isa()
        self._names: Names | None = None
        self._number: int | None = None
        self._bounded: tuple[Names, Json | None] | None = None
        self._checks: Checks | None = None
        self._blobs: Sequence[bytes] = ()
        self._module: bytes | None = None
        self._run: _Run | None = None
        self._methods: Mapping[str, Callable[..., Any]] = {
            "language": self._language,
            "compile": self._compile,
            "whole": self._whole,
            "bounds": self._bounds,
            "condition": self._condition,
            "writers": self._writers,
            "tests": self._tests,
            "judge": self._judge,
        }

    def call(self, method: str, arguments: str, blobs: Sequence[bytes] = ()) -> Answer:
        """Call a method of ``Compiler``.

        Args:
            method: its name.
            arguments: JSON: the list of its arguments; instead of bytes there are indices in
                `blobs`.
            blobs: the bytes.
        """
        self._blobs, self._module = tuple(blobs), None
        try:
            value = self._methods[method](*json.loads(arguments))
        except NpchipError as error:
            forgotten = isinstance(error, ForgottenError)
            return Answer(json.dumps({"error": _shown(error), "forgotten": forgotten}), None)
        return Answer(json.dumps({"value": value}, separators=(",", ":")), self._module)

    def _language(self) -> Json:
        return language(self._isa)

    def _compile(self, request: Json) -> Json:
        number = request.pop("number", None)
        found: list[Json] = []
        program: Json | None = None
        started = time.perf_counter()
        try:
            made = self._assemble(request, found)
            program = described(*made, self._isa)
        except NpchipError as error:
            found = [*diagnostics(error), *found]
        assembled = time.perf_counter()
        if program is not None:
            try:
                self._translate(request, made)
                self._number = number
            except NpchipError as error:
                program, found = None, [*diagnostics(error), *found]
        times = {"assemble": assembled - started, "translate": time.perf_counter() - assembled}
        return {
            "diagnostics": found,
            "program": program,
            "module": None,
            "milliseconds": {name: 1000 * taken for name, taken in times.items()},
        }

    def _assemble(self, request: Json, warnings: list[Json]) -> Assembled:
        definitions: list[Definition] = []
        with self._folder.holding(request["project"]) as main:
            machine = machine_of(request["machine"], self._isa)
            program = assemble(
                main,
                machine,
                request["defines"],
                self._isa,
                on_warning=lambda item: warnings.append(diagnostic(item)),
                on_definition=definitions.append,
            )
        check_fit(program, machine, self._isa)
        return Assembled(program, machine, definitions)

    def _translate(self, request: Json, made: Assembled) -> None:
        if request["module"]:
            translated = made.program, made.machine, self._isa, self._memory(request, made)
            if request["module"] == "run":
                self._module = run_form(*translated)
                self._run = _Run({**request, "module": True}, self._blobs, made, self._module)
            else:
                self._module = to_module(*translated)
        self._names = Names(made.program, made.machine, self._isa)

    def _whole(self, request: Json) -> None:
        run = self._run
        if run is None or (run.request, run.blobs) != ({**request, "module": True}, self._blobs):
            made = self._assemble(request, [])
            memory = self._memory(request, made)
            self._module = to_module(made.program, made.machine, self._isa, memory)
        else:
            memory = self._memory(request, run.made)
            program, machine = run.made.program, run.made.machine
            self._module = with_stepping(run.module, program, machine, self._isa, memory)

    def _memory(self, request: Json, made: Assembled) -> Memory:
        given = _memory(request["memory"], self._blobs, made.machine)
        return bound(made.program, made.machine, self._tables, self._folder.path, given)

    def _bounds(self, number: int | None = None) -> Json | None:
        names = self._compiled(number)
        if self._bounded is None or self._bounded[0] is not names:
            self._bounded = names, bounds(names.program, names.machine, self._isa)
        return self._bounded[1]

    def _condition(self, text: str, number: int | None = None) -> Json:
        return condition_tree(text, self._compiled(number))

    def _writers(self, value: Json, number: int | None = None) -> list[int]:
        return sorted(self._compiled(number).writers.of(quantity_of(value)))

    def _compiled(self, number: int | None) -> Names:
        """Return what is known of the program that a question is about.

        Args:
            number: that of the request that it was compiled for; None for the last program.

        Raises:
            ForgottenError: NP351, it is not the program that was compiled last.
        """
        if self._names is None:
            raise ForgottenError("NP351", "no program has been compiled yet")
        if number is not None and number != self._number:
            raise ForgottenError("NP351", "another program has been compiled since")
        return self._names

    def _tests(self, request: Json) -> Json:
        self._checks = None
        try:
            with self._folder.holding(request["project"]) as main:
                self._checks = Checks(main, self._isa, self._tables)
        except NpchipError as error:
            return {"runs": [], "diagnostics": [*diagnostics(error)]}
        return {"runs": self._checks.runs(), "diagnostics": []}

    def _judge(self, run: str, machine: str, result: Json) -> list[Json]:
        if self._checks is None:
            raise InputError("NP275", "the test lines have not been read yet")
        return self._checks.judge(run, machine, result)


def _shown(error: NpchipError) -> str:
    """Return the message of an error in one line or two, without an excerpt of the source."""
    if isinstance(error, CommandError):
        found = error.diagnostic
        return f"{found.message} [{found.code}]" + (
            f"\n{found.suggestion}" if found.suggestion else ""
        )
    return f"{error.message} [{error.code}]" + (f"\n{error.hint}" if error.hint else "")


def _memory(parts: Sequence[Json], blobs: Sequence[bytes], machine: Machine) -> Memory:
    """Return what lies in the NPs' memory, as planes.

    Raises:
        InputError: NP243, a part does not fit the machine.
    """
    size = machine.np_rows * machine.np_cols
    found = []
    for part in parts:
        first, count, data = part["address"], part["planes"], blobs[part["data"]]
        if not 0 <= first <= first + count <= machine.memory_bytes or len(data) != count * size:
            raise InputError(
                "NP243",
                f"{len(data)} bytes at address {first} are not {count} bytes of each of the "
                f"{machine.np_rows} x {machine.np_cols} NPs' {machine.memory_bytes}",
            )
        found.append((first, [data[size * k : size * (k + 1)] for k in range(count)]))
    return found
