"""A sweep: what is missing is computed, here or on a cluster, and tables are written."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from npchip.base.errors import InputError
from npchip.base.files import locked, make_directory, write_text
from npchip.sweep import local, provenance
from npchip.sweep.batches import batches, check
from npchip.sweep.file import read
from npchip.sweep.model import Definition
from npchip.sweep.plan import Run, expand
from npchip.sweep.store import JOURNAL, Store
from npchip.sweep.work import Done

if TYPE_CHECKING:
    import pandas as pd

TABLES: Final = ("runs.parquet", "runs.csv")
_GOOD: Final = {"halted", "frames-exhausted", "done"}


@dataclass(frozen=True)
class Outcome:
    """The end of a sweep.

    Attributes:
        folder: where its tables are.
        rows: number of rows of the table.
        computed: number of runs computed by this call.
        failed: number of rows whose run failed.
    """

    folder: Path
    rows: int
    computed: int
    failed: int

    def table(self) -> pd.DataFrame:
        """Return the table of the runs."""
        need("pandas", "a table of pandas")
        import pandas as pd  # noqa: PLC0415 - with an extra

        return pd.read_parquet(self.folder / TABLES[0])


@dataclass(frozen=True)
class Sweep:
    """A sweep file that makes sense; `load` reads one.

    Attributes:
        path: the file.
        definition: what it says.
    """

    path: Path
    definition: Definition

    @cached_property
    def runs(self) -> Sequence[Run]:
        """The runs, in the order of the table's rows."""
        return expand(self.definition)

    @property
    def folder(self) -> Path:
        """The folder of the tables if nothing else is said."""
        return Path(self.definition.name)

    def missing(self, folder: Path | None = None) -> list[Run]:
        """Return the runs that are not yet done in a folder."""
        where = folder or self.folder
        if not (where / JOURNAL).is_file():
            return list(self.runs)
        with Store(where) as store:
            return self._missing(store)

    def _missing(self, store: Store) -> list[Run]:
        wanted = self.definition.frames
        return [run for run in self.runs if not store.has(run.key, frames=wanted)]

    def run(
        self,
        jobs: int | None = None,
        *,
        folder: str | Path | None = None,
        scheduler: str | None = None,
        on_run: Callable[[Done], None] | None = None,
    ) -> pd.DataFrame:
        """Compute what is missing, write the tables and return that of the runs.

        Args, errors: as `complete`.
        """
        need("pandas", "a table of pandas")
        return self.complete(jobs, folder=folder, scheduler=scheduler, on_run=on_run).table()

    def complete(
        self,
        jobs: int | None = None,
        *,
        folder: str | Path | None = None,
        scheduler: str | None = None,
        on_run: Callable[[Done], None] | None = None,
    ) -> Outcome:
        """Compute what is missing and write the tables.

        However this ends, what is done is kept, and the tables show it.

        Args:
            jobs: number of processes; 0 for this one, None for one for each core.
            folder: where journal and tables are.
            scheduler: address of a Dask scheduler, whose workers are taken instead.
            on_run: is called with each run that has been computed.

        Raises:
            InputError: NP026 a program lacks a constant, NP250 the folder cannot be written, NP640
                a library is not installed, NP648 to NP650 the cluster or a process is gone.
        """
        need("pyarrow", "a sweep")
        where = Path(folder) if folder is not None else self.folder
        make_directory(where)
        with locked(where), Store(where) as store:
            missing = self._missing(store)
            if missing:  # until it is written again, the tables are not those of the journal
                (where / provenance.FILE).unlink(missing_ok=True)
            try:
                for done in self._results(missing, jobs, scheduler):
                    store.add(done)
                    if on_run is not None:
                        on_run(done)
            finally:
                self._write(store)
            rows = [store.row(run.key) for run in self.runs]
        found = [row for row in rows if row is not None]
        failed = sum(row["status"] not in _GOOD for row in found)
        return Outcome(where, len(found), len({run.key for run in missing}), failed)

    def _results(
        self, missing: Sequence[Run], jobs: int | None, scheduler: str | None
    ) -> Iterator[Done]:
        if not missing:
            return
        if not self.definition.experiment:
            check(missing)
        with ExitStack() as opened:
            if scheduler is None:
                workers = local.cores() if jobs is None else jobs
                if workers:
                    need("joblib", "a sweep in several processes")
                work = batches(self.definition, missing, workers)
                found = local.run(work, workers)
            else:
                need("distributed", "--scheduler")
                from npchip.sweep.cluster import Cluster  # noqa: PLC0415 - takes a second

                cluster = Cluster(scheduler)
                opened.callback(cluster.close)
                found = cluster.run(batches(self.definition, missing, cluster.workers))
            for each in opened.enter_context(closing(found)):  # type: ignore[type-var]
                yield from each

    def _write(self, store: Store) -> None:
        """Write the tables, unless they are what they would become."""
        names = [*TABLES, *(["frames.parquet"] if self.definition.frames else [])]
        source = self.path.read_text("utf-8")
        done = sum(run.key in store for run in self.runs)
        text = provenance.text(self.definition, self.runs, source, done)
        about = store.folder / provenance.FILE
        if all((store.folder / name).is_file() for name in (*names, provenance.FILE)):
            if about.read_text("utf-8") == text:
                return
            about.unlink()
        from npchip.sweep import tables  # noqa: PLC0415 - pyarrow takes long to load

        tables.write_runs(self.runs, store)
        if self.definition.frames:
            tables.write_frames(self.runs, store)
        write_text(about, text)


def load(path: str | Path) -> Sweep:
    """Read a sweep file.

    Args:
        path: the file.

    Raises:
        InputError: it makes no sense; the message names file and line.
    """
    return Sweep(Path(path), read(Path(path)))


def need(module: str, what: str) -> None:
    """Raise where a library of the extra ``sweep`` is not installed.

    Raises:
        InputError: NP640.
    """
    if find_spec(module) is None:
        hint = "pip install 'npchip[sweep]' installs it"
        raise InputError("NP640", f"{what} needs {module}", hint=hint)
