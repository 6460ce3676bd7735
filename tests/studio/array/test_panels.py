"""The panels of the array in a browser: keys and clicks use them, and axe looks at them."""

from __future__ import annotations

import html
import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip import Chip, assemble_text
from tests.studio.array.asking import info_of, plain, view_of
from tests.support.page_code import PAGE, Bundles, browser, esbuild, here

pytestmark = pytest.mark.long

SOURCE = """
.equ PLACE, 70
.reg sum, r1
        MOV r0, #7
        NBR sum, r2, west
        HALT
"""


def page_in(folder: Path, bundles: Bundles) -> Path:
    """A page that walks through the panels by itself, in a file."""
    script = bundles.for_browsers("array/page.tsx")
    css = folder / "page.css"
    sheets = [PAGE / "shell" / "theme.css", PAGE / "array" / "array.css"]
    imports = "".join(f'@import "{sheet}";\n' for sheet in sheets)
    esbuild(imports, css, "--loader=css")
    program = assemble_text(SOURCE, "test.s")
    chip = Chip(program, engine="reference")
    chip.registers[2] = np.arange(80).reshape(8, 10)
    views = []
    for _ in range(3):
        shape = {"frame": -1, "frameCycles": chip.cycles, "frameInstructions": chip.instructions}
        rest = {"cycles": chip.cycles, "stack": [], "depth": 0, "masks": [], "ended": False}
        views.append(view_of(chip, **shape, **rest, registers=chip.registers.copy()))
        chip.step()
    machine = {"np_rows": 8, "np_cols": 10, "memory_bytes": 256}
    info = info_of(program) | {"machine": machine, "symbols": dict(program.symbols)}
    data = json.dumps({"program": info, "views": views}, default=plain)
    made = folder / "page.html"
    made.write_text(
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>array</title>'
        f'<link rel="stylesheet" href="{css.name}"><body style="background: var(--bg)">'
        f"<script>const DATA = {data};</script>"
        f'<script src="{script.as_uri()}"></script></body></html>',
        encoding="utf-8",
    )
    return made


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory, bundles: Bundles) -> dict[str, Any]:
    """Findings of the page when it walked through the panels."""
    chromium = here(lambda: browser("chromium"))
    folder = tmp_path_factory.mktemp("array")
    page = page_in(folder, bundles)
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile"]
    done = subprocess.run(
        [chromium, *options, "--virtual-time-budget=60000", "--dump-dom", page.as_uri()],
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    result = re.search(r"<pre>(.*?)</pre>", done.stdout, re.DOTALL)
    assert result is not None, done.stdout[-2000:] + done.stderr[-2000:]
    walked: dict[str, Any] = json.loads(html.unescape(result[1]))
    assert walked.get("fault") is None
    return walked


def test_the_grid_is_one_tab_stop_and_chooses_with_keys_and_clicks(found: dict[str, Any]) -> None:
    labels = [f"NP {row}, {column}: 0" for row in range(8) for column in range(10)]
    assert found["cells"] == [labels[0] + ", chosen", *labels[1:]]
    assert found["focused"] == "NP 1, 1: 0"
    assert found["chosen"] == {"row": 1, "column": 1}
    assert found["clicked"] == {"row": 2, "column": 3}
    assert found["stops"] == 1
    assert found["heading"] == "NP 2, 3"


def test_values_pass_along_arrows_after_a_read_of_a_neighbour(found: dict[str, Any]) -> None:
    assert found["none"] == 0
    assert found["arrows"] == 80
    west = [0 if at % 10 == 0 else at - 1 for at in range(80)]
    assert found["values"] == [str(value) for value in west]
    assert found["legend"] == "Arrows: each active NP took r2 of the NP to its west."
    assert found["changed"] == ["r1 sum, changed"]


def test_the_menu_of_a_value_finds_its_writer_and_stops_at_changes(found: dict[str, Any]) -> None:
    assert found["menu"] == "Who wrote this?"
    assert found["second"] == "Stop when it changes"
    assert found["left"].startswith("r1 sum")
    register = {"kind": "register", "index": 1}
    assert ["who", {"kind": "one", "cell": register, "row": 2, "column": 3}] in found["asked"]
    assert found["conditions"] == ["np(2,3).r1 changes"]


def test_the_chooser_shows_banks_and_bytes_by_name(found: dict[str, Any]) -> None:
    assert found["bank:128"] == "NPs: memory bank 128"
    assert found["memory:"] == "NPs: memory byte 0"
    wrong = "Give an address from 0 to 255, or the name of a constant."
    assert found["outside"] == wrong
    assert found["byName"] == {"kind": "memory", "index": 70}


def test_what_is_wrong_with_a_condition_stands_beneath_it(found: dict[str, Any]) -> None:
    assert found["refused"] == "no such condition"
    assert found["wrong"] == "error[NP351]: no register 'wrong'"
    assert found["all"] == ["np(2,3).r1 changes", "any r0 > 1"]
    assert ["enable", "test.s:3", False] in found["asked"]


def test_buttons_and_keys_step_but_not_while_one_types(
    found: dict[str, Any],
) -> None:
    assert found["obstacle"] == "Put the editor's cursor on a line with an instruction first."
    assert [each for each in found["asked"] if each[0] == "go"] == [
        ["go", {"to": "over"}, True],
        ["go", {"to": "cursor", "file": "test.s", "line": 4}, False],
        ["go", {"to": "step"}, True],
        ["go", {"to": "frame"}, False],
        ["go", {"to": "step"}, False],  # while it runs: the shell pauses it first
    ]


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing(found: dict[str, Any], theme: str) -> None:
    assert found[theme] == []
