"""Objects and ROM images of absurd sizes are refused at once."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import pytest

from npchip import assemble_text
from npchip.base.errors import InputError
from npchip.formats import load_program, write_program


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outputs": [{"name": "a", "port": 1, "kind": "plane"}] * 100_000}, "100000 outputs"),
        ({"outputs": [{"name": "a", "port": p, "kind": "plane"} for p in (1, 2)]}, "same name"),
        ({"outputs": [{"name": n, "port": 1, "kind": "plane"} for n in "ab"]}, "same port"),
        ({"words": ["0000"] * 1_000_000, "source": []}, "1000000 words"),
    ],
)
def test_objects_of_absurd_sizes(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    """100,000 outputs took 14 seconds; two of one name were accepted."""
    file = tmp_path / "p.npo"
    write_program(assemble_text(" HALT"), file)
    file.write_text(json.dumps(json.loads(file.read_text()) | change))
    before = time.process_time()
    with pytest.raises(InputError, match=message) as caught:
        load_program(file)
    assert caught.value.code == "NP111"
    assert time.process_time() - before < 2


@pytest.mark.parametrize(
    ("name", "data"),
    [("p.bin", b"\0\1" * 1025), ("p.hex", b"0001\n" * 1025), ("p.mem", b"@400 0001")],
)
def test_images_larger_than_any_rom(tmp_path: Path, name: str, data: bytes) -> None:
    """`disasm` wrote a source of them that `asm` refuses."""
    file = tmp_path / name
    file.write_bytes(data)
    with pytest.raises(InputError, match="more than the 1024 words") as caught:
        load_program(file)
    assert caught.value.code == "NP112"


def test_a_byte_order_mark_before_a_readmemh_text(tmp_path: Path) -> None:
    """It was refused as part of the first word, without being visible."""
    program = assemble_text(" HALT")
    file = tmp_path / "p.hex"
    write_program(program, file)
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())
    assert load_program(file).words == program.words
