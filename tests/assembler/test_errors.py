"""Messages of the assembler about mistakes: a file in ``tests/asm/errors`` is a test.

``NAME.s`` is assembled and what the assembler says is compared with ``NAME.expected``.
``NPCHIP_UPDATE=1 pytest tests/assembler/test_errors.py`` writes the goldens anew; read them.
Comments ``; test: define NAME=VALUE`` and ``; test: include FOLDER`` are options of the run.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from npchip.assembler import assemble
from npchip.assembler.codes import CODES, markdown
from npchip.base.errors import NpchipError

FOLDER = Path(__file__).parents[1] / "asm" / "errors"
SOURCES = sorted(FOLDER.glob("*.s"))
DOC = Path(__file__).parents[2] / "docs" / "errors.md"
BEGIN = "<!-- assembler: made by npchip.assembler.codes, with NPCHIP_UPDATE=1 -->\n"
END = "<!-- assembler: end -->\n"

pytestmark = pytest.mark.filterwarnings("error")


def updating() -> bool:
    if not os.environ.get("NPCHIP_UPDATE"):
        return False
    assert not os.environ.get("CI"), "NPCHIP_UPDATE does not go with CI: goldens are to be read"
    return True


def said(source: Path) -> str:
    """All that the assembler says of a file, its name without folders."""
    text = source.read_bytes().decode("utf-8", errors="replace")
    defines = {name: int(value) for name, value in re.findall(r"; test: define (\w+)=(\d+)", text)}
    folders = re.findall(r"; test: include (\S+)", text)
    warnings: list[str] = []
    before = Path.cwd()
    os.chdir(FOLDER)
    try:
        assemble(
            source.name,
            defines=defines,
            include_paths=folders,
            on_warning=lambda item: warnings.append(str(item)),
        )
    except NpchipError as error:
        return f"{error}\n"
    finally:
        os.chdir(before)
    return "".join(f"{item}\n" for item in warnings)


def test_there_are_files() -> None:
    assert len(SOURCES) >= 65
    assert {path.stem for path in SOURCES} == {path.stem for path in FOLDER.glob("*.expected")} or (
        updating()
    )


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_diagnostics(source: Path) -> None:
    golden = source.with_suffix(".expected")
    found = said(source)
    if updating():
        golden.write_text(found, encoding="utf-8", newline="\n")
    assert found == golden.read_text(encoding="utf-8")
    assert found, "a file without mistakes"


def test_every_code_is_listed_and_shown() -> None:
    goldens = {path.stem: path.read_text("utf-8") for path in FOLDER.glob("*.expected")}
    raised = set(re.findall(r"\[(NPW?\d+)\]$", "\n".join(goldens.values()), re.MULTILINE))
    assert raised == {item.code for item in CODES}
    for item in CODES:
        assert f"[{item.code}]" in goldens[item.example], item.code


def test_codes_in_the_package_are_listed() -> None:
    package = Path(__file__).parents[2] / "src" / "npchip"
    written = {
        code
        for room in ("assembler", "program")
        for path in (package / room).glob("*.py")
        if path.name != "codes.py"
        for code in re.findall(r'"(NPW?\d+)"', path.read_text("utf-8"))
    }
    assert written == {item.code for item in CODES}


def test_documentation() -> None:
    text = DOC.read_text("utf-8")
    assert BEGIN in text
    assert END in text
    head, rest = text.split(BEGIN)
    _, tail = rest.split(END)
    wanted = head + BEGIN + markdown(FOLDER) + END + tail
    if updating():
        DOC.write_text(wanted, encoding="utf-8", newline="\n")
    assert DOC.read_text("utf-8") == wanted
