"""Whatever is clicked, and however late things answer, the page shows what the last run told."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, load_machine
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.report.jsonform import to_document
from tests.support.clips import bundled_clips
from tests.support.page_code import Bundles, run
from tests.support.programs import assembled

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.long

PROGRAMS = ("tracking", "trajectory", "statistics")
CLIPS = {"shapes_drawn": 4, "mouse_run": 9, "coin_slide": 30}
"""Clips and how many of their frames; each is that of the example in the same place."""
SEQUENCES = 40


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's examples and clips, with what each program gives on each clip."""
    folder = tmp_path_factory.mktemp("page")
    films = {name: bundled_clips()[name][:count] for name, count in CLIPS.items()}
    (folder / "clips").mkdir()
    (folder / "programs").mkdir()
    for name, film in films.items():
        np.save(folder / "clips" / f"{name}.npy", np.diff(film, axis=0, prepend=np.uint8(0)))
    listed = [
        {"name": name, "title": name, "count": len(film), "rows": 64, "cols": 80, "fps": 30}
        for name, film in films.items()
    ]
    (folder / "clips/index.json").write_text(json.dumps(listed))
    for name in PROGRAMS:
        module = to_module(assembled(name), load_machine("default"), load_isa(), ())
        (folder / f"programs/{name}.wasm").write_bytes(module)
        (folder / f"programs/{name}.json").write_text(json.dumps(compiled(name)))
    examples = [example(name, clip) for name, clip in zip(PROGRAMS, CLIPS, strict=True)]
    (folder / "programs/index.json").write_text(json.dumps(examples))
    truth = {name: {clip: outputs(name, film) for clip, film in films.items()} for name in PROGRAMS}
    (folder / "truth.json").write_text(json.dumps(truth))
    return folder


def compiled(name: str) -> dict[str, Any]:
    """Return a program translated before, as the page has it, as far as a run needs it."""
    machine = {"name": "default", "np_rows": 8, "np_cols": 10}
    program = {"name": name, "words": [], "outputs": [], "machine": machine, "exposes": True}
    return {"diagnostics": [], "program": program, "module": None}


def example(name: str, clip: str) -> dict[str, Any]:
    project = {"main": f"{name}.s", "files": {f"{name}.s": ""}}
    return {"name": name, "summary": "", "project": project, "clip": clip, "memory": []}


def outputs(name: str, film: Any) -> list[dict[str, Any]]:
    frames = to_document(Chip(assembled(name)).run(film), 1)["frames"]
    return [{"cycles": frame["cycles"], "outputs": frame["outputs"]} for frame in frames]


def test_no_run_is_shown_as_another(files: Path, bundles: Bundles) -> None:
    script = bundles.for_node("shell/clicks.ts")
    found = json.loads(run(script, str(files), "0", str(SEQUENCES), seconds=300))
    assert found["faults"] == []
    assert found["compared"] > 5 * SEQUENCES
