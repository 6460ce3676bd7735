"""``.memory`` lines in the page, which has no files but those of bundled programs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from npchip.assembler import assemble
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.machine import load_machine
from npchip.studio.precompiled import bundled_tables
from npchip.studio.toolchain.facade import Toolchain
from npchip.studio.toolchain.tables import from_text, to_text
from tests.studio.compiler.calls import bundled, call, call_with_module, request
from tests.support.programs import ASM

OWN = '.memory {address}, "{name}"\n.output a, 0, plane\n LD r0, [{address}]\n OUT 0, r0\n HALT\n'


@pytest.fixture
def toolchain(tmp_path: Path) -> Toolchain:
    return Toolchain(tmp_path / "project", from_text(to_text(bundled_tables())))


def test_a_bundled_program_gets_its_file(toolchain: Toolchain) -> None:
    value, module = call_with_module(toolchain, "compile", request(bundled("digits")))
    assert value["diagnostics"] == []
    machine = load_machine("default")
    memory = [(128, np.load(ASM / "digits.npy"))]
    assert module == to_module(assemble(ASM / "digits.s", machine), machine, load_isa(), memory)


def test_the_module_that_can_step_gets_it_too(toolchain: Toolchain) -> None:
    wanted = request(bundled("digits"))
    _, module = call_with_module(toolchain, "compile", wanted)
    call(toolchain, "compile", request(bundled("digits"), module="run"))
    assert call_with_module(toolchain, "whole", wanted)[1] == module


def test_a_readers_program_may_name_a_bundled_file(toolchain: Toolchain) -> None:
    text = OWN.format(address=3, name="digits.npy")
    value, module = call_with_module(toolchain, "compile", request(text))
    assert value["diagnostics"] == []
    assert module is not None
    assert np.load(ASM / "digits.npy").tobytes()[:80] in module


def test_what_is_given_takes_its_place(toolchain: Toolchain) -> None:
    text = OWN.format(address=3, name="mine.npy")
    given = request(text, memory=[{"address": 3, "planes": 1, "data": 0}])
    blob = bytes(range(100, 180))
    value, module = call_with_module(toolchain, "compile", given, blobs=[blob])
    assert value["diagnostics"] == []
    assert module is not None
    assert blob in module


@pytest.mark.parametrize(
    ("name", "machine", "said"),
    [
        ("mine.npy", "default", "mine.npy is not in this page"),
        (
            "digits.npy",
            {"name": "small", "text": "extends: default\ngeometry: {np_cols: 9}\n"},
            "digits.npy is for another array",
        ),
    ],
)
def test_a_file_that_the_page_has_not_is_told_at_its_line(
    toolchain: Toolchain, name: str, machine: object, said: str
) -> None:
    value = call(toolchain, "compile", request("\n" + OWN.format(address=3, name=name), machine))
    (found,) = value["diagnostics"]
    assert (found["code"], found["message"]) == ("NP243", said)
    assert (found["place"]["file"], found["place"]["line"]) == ("program.s", 2)
    assert value["program"] is None
