"""Provenance of a table: versions, hashes and the command, in ``sweep.json``."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any, Final

from npchip.base.json import indented
from npchip.sweep import content
from npchip.sweep.model import ClipFile, Definition
from npchip.sweep.plan import Run

SCHEMA: Final = 1
FILE: Final = "sweep.json"
_LIBRARIES: Final = ("numpy", "pillow", "pyarrow", "wasmtime")
"""Libraries that results, or the bytes of the tables, can depend on."""


def text(definition: Definition, runs: Sequence[Run], source: str, done: int) -> str:
    """Return the text of ``sweep.json``; equal sweeps of equal versions give equal texts.

    Args:
        definition: the sweep.
        runs: its runs.
        source: text of the sweep file.
        done: number of rows in the table.
    """
    versions = {"npchip": content.version(), "python": platform.python_version()}
    for name in _LIBRARIES:
        with suppress(PackageNotFoundError):
            versions[name] = version_of(name)
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "command": f"npchip sweep {Path(definition.file).name}",
        "versions": versions,
        "file": source,
        "programs": {item.label: content.of_program(item.path) for item in definition.programs},
        "clips": _clips(runs),
        "machines": [
            {"name": item.label, **item.axes, "hash": content.of_machine(item.machine)}
            for item in definition.machines
        ],
        "runs": {
            "planned": len(runs),
            "in the table": done,
            "hash": content.digest([[run.key, *map(list, run.axes)] for run in runs]),
        },
    }
    if definition.experiment:
        document["experiment"] = content.of_experiment(definition.experiment)
    return indented(document, ascii_only=False)


def _clips(runs: Sequence[Run]) -> list[dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    for run in runs:
        if run.clip is not None:
            entry: dict[str, Any] = {"name": run.clip.label}
            if not isinstance(run.clip, ClipFile):
                entry["seed"] = run.clip.seed
            found.setdefault(run.clip_key, entry | {"hash": run.clip_key})
    return list(found.values())
