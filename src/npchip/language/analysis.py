"""All that is known of a program while it is being written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from npchip.assembler.examine import Examined, examine
from npchip.assembler.sources import split_lines
from npchip.base.errors import NpchipError
from npchip.isa import Isa, load_isa
from npchip.language.names import Names
from npchip.language.places import diagnostic, diagnostics
from npchip.language.settings import Settings, find, read_settings
from npchip.machine import Machine, load_machine

_T = TypeVar("_T")
_Stamp = tuple[int, int]


class Cost(NamedTuple):
    """Cost of a line of a source: words, and their cycles on the chosen machine."""

    words: int = 0
    cycles: int = 0


@dataclass(frozen=True, eq=False)
class Analysis:
    """A program with the files that it includes.

    Attributes:
        root: the program's file.
        settings: what its project says.
        isa: the instruction set.
        machine: the machine.
        examined: what the assembler found; None if it could not begin.
        faults: errors and warnings, as `npchip.language.places` has them.
    """

    root: Path
    settings: Settings
    isa: Isa
    machine: Machine
    examined: Examined | None
    faults: Sequence[Mapping[str, Any]]

    @cached_property
    def paths(self) -> Mapping[str, Path]:
        """The real path of each file that was read, by its name in messages."""
        found = {str(self.root): self.root.resolve()}
        if self.examined is not None:
            for name, file in self.examined.expander.sources.files.items():
                found[name] = file.path or found[str(self.root)]
        return found

    def file(self, path: Path) -> str | None:
        """Return the name in messages of a file that was read."""
        return next((name for name, real in self.paths.items() if real == path), None)

    @cached_property
    def names(self) -> Names:
        """The meanings of the names in the files."""
        if self.examined is None:
            return Names((), self.isa)
        files = self.examined.expander.sources.files.values()
        return Names((file.nodes for file in files), self.isa)

    @cached_property
    def values(self) -> Mapping[str, int]:
        """The values of constants, those of the geometry included."""
        return self.examined.expander.symbols.known() if self.examined else {}

    @cached_property
    def costs(self) -> Mapping[tuple[str, int], Cost]:
        """The cost of each line that makes words, a line that expands a macro included."""
        program = self.examined.program if self.examined else None
        if program is None:
            return {}
        found: dict[tuple[str, int], Cost] = {}
        for cycles, line in zip(
            program.cycles(self.machine, self.isa), program.source, strict=True
        ):
            for origin in set(line.origins):
                key = (origin.file, origin.line)
                words, sum_ = found.get(key, Cost())
                found[key] = Cost(words + 1, sum_ + cycles)
        return found


class Analyst:
    """Analyses programs; it reads instruction sets, machines and projects once, until they change.

    Attributes:
        texts: texts that stand for files, by real path: those that are open in an editor.
    """

    def __init__(self) -> None:
        self.texts: dict[Path, str] = {}
        self._read: dict[Path, tuple[_Stamp | None, Any]] = {}

    def analyse(self, root: Path) -> Analysis:
        """Return what is known of a program; whatever is wrong is among its faults."""
        errors: list[NpchipError] = []

        def attempt(step: Callable[[], _T], otherwise: Callable[[], _T]) -> _T:
            try:
                return step()
            except NpchipError as error:
                errors.append(error)
                return otherwise()

        settings = attempt(lambda: self.settings(root), Settings)
        isa = attempt(lambda: self._isa(settings), load_isa)
        machine = attempt(lambda: settings.load_machine(isa), lambda: load_machine("default"))
        examined = attempt(
            lambda: examine(
                root,
                machine,
                settings.defines,
                isa,
                include_paths=settings.include,
                texts=self.texts,
            ),
            lambda: None,
        )
        faults = [fault for error in errors for fault in diagnostics(error)]
        if examined is not None:
            if examined.error is not None:
                faults += diagnostics(examined.error)
            faults += map(diagnostic, examined.warnings)
        return Analysis(root, settings, isa, machine, examined, faults)

    def settings(self, source: Path) -> Settings:
        """Return the settings of the project that a source belongs to.

        Raises:
            InputError: NP670, the project file cannot be used.
        """
        file = find(source)
        return Settings() if file is None else self._once(file, lambda: read_settings(file))

    def _isa(self, settings: Settings) -> Isa:
        if settings.isa is None:
            return load_isa()
        return self._once(settings.isa, settings.load_isa)

    def _once(self, path: Path, read: Callable[[], _T]) -> _T:
        stamp = _stamp(path)
        known = self._read.get(path)
        if known is None or known[0] != stamp or stamp is None:
            self._read[path] = known = (stamp, read())
        value: _T = known[1]
        return value

    def lines(self, path: Path) -> list[str]:
        """Return the lines of a file, as it is open in the editor or else as it is saved."""
        text = self.texts.get(path)
        if text is None:
            try:
                text = path.read_text(encoding="utf-8", errors="replace")
            except OSError:
                return []
        return split_lines(text)


def _stamp(path: Path) -> _Stamp | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
