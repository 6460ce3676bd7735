"""Memory that is known to be 0 after the reset level was converted: what that is used for."""

from __future__ import annotations

from collections import Counter

import pytest

from npchip import assemble_text
from npchip.engines.wasm.translate.analysis import uniformity, use_zeros
from npchip.engines.wasm.translate.block import Executor
from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.summary import SAME
from npchip.engines.wasm.translate.unroll import unroll
from npchip.isa import load_isa
from npchip.program.graph import Place
from tests.engines.wasm.test_engine import both
from tests.support.chips import machine_of

MACHINE = machine_of()
BEFORE = "EXPOSE\nCOL r0\nROW r1\nADD r1, #5\nMOV r2, #9\nCMP r0, #2\nSAMPLE reset, 64\n"
SAVED = "\nST [200], r5\nST [201], r6\nST [202], r7\nHALT"
LOOP = "MOV r3, #{first}\nl: LD r4, [r3 + 64]\nADD r5, r4\nADD r3, #1\nCMP r3, #{end}\nJANY LO, l"
SOURCES = {
    "constant addresses": "LD r5, [64]\nLD r6, [127]\nLD r7, [128]",
    "stored at once": "ST [70], r1\nLD r5, [70]\nLD r6, [71]",
    "stored by another name": "MOV r3, #6\nST [r3 + 64], r1\nLD r5, [70]\nLD r6, [71]",
    "stored each NP elsewhere": "ST [r0 + 64], r1\nLD r5, [64]\nLD r6, [65]\nLD r7, [66]",
    "stored anywhere": "ST [r8 + 64], r1\nLD r5, [64]\nLD r6, [65]",
    "zeros anywhere": "ST [9], r2\nMOV r6, #0\nST [r8 + 0], r6\nLD r5, [0]\nLD r6, [9]",
    "a zero stored": "ST [128], r1\nMOV r6, #0\nST [128], r6\nLD r5, [128]",
    "a zero stored by some": (
        "ST [128], r1\nMOV r6, #0\nWHERE LO\nST [128], r6\nEND\nLD r5, [128]\nLD r6, [64]"
    ),
    "stored by some": "WHERE LO\nST [64], r1\nELSE\nST [65], r2\nEND\nLD r5, [64]\nLD r6, [65]",
    "the signal instead": "SAMPLE signal, 64\nLD r5, [64]\nLD r6, [127]",
    "the signal for some": "WHERE LO\nSAMPLE signal, 64\nEND\nLD r5, [64]\nLD r6, [127]",
    "zeros for some": (
        "SAMPLE signal, 128\nWHERE LO\nSAMPLE reset, 128\nEND\nLD r5, [128]\nLD r6, [191]"
    ),
    "again for some": "ST [64], r1\nWHERE LO\nSAMPLE reset, 64\nEND\nLD r5, [64]\nLD r6, [65]",
    "again": "ST [64], r1\nSAMPLE reset, 64\nLD r5, [64]\nSAMPLE reset, 64\nLD r6, [64]",
    "a loop up to the last byte": LOOP.format(first=0, end=64),
    "a loop over a byte that is not": "ST [67], r1\n" + LOOP.format(first=1, end=4),
    "a loop beyond the bank": "ST [128], r1\n" + LOOP.format(first=1, end=65),
    "a loop that stores": (
        LOOP.format(first=0, end=7).replace("ADD r3", "ST [r3 + 64], r2\nADD r3")
        + "\nLD r6, [71]\nLD r7, [72]"
    ),
    "two ways": (
        "JANY EQ, on\nSAMPLE reset, 128\nMOV r3, #1\nST [64], r1\n"
        "on: LD r5, [64]\nLD r6, [128]\nLD r7, [65]"
    ),
    "a loop of frames": (
        "frame: EXPOSE\nLD r7, [66]\nSAMPLE reset, 64\nSAMPLE signal, 0\nLD r5, [64]\nLD r6, [9]\n"
        "ST [66], r6\nOUT 0, r5\nOUT 0, r6\nOUT 0, r7\nJMP frame"
    ),
}


@pytest.mark.parametrize("name", SOURCES)
def test_loads_from_zeros_see_what_is_there(name: str) -> None:
    both(BEFORE + SOURCES[name] + SAVED, frames=4)


@pytest.mark.parametrize(
    "source",
    [
        "LD r1, [5]\nCMP r0, r0\nWHERE EQ\nST [5], r7\nEND\nLD r4, [5]",
        (
            "LD r1, [5]\nLD r2, [5]\nWHERE LO\nMOV r1, r8\nEND\nWHERE LO\nMOV r1, r9\n"
            "MOV r2, r9\nEND\nCMP r1, r2\nWHERE EQ\nMOV r4, r7\nEND"
        ),
    ],
)
def test_what_is_less_well_known_with_zeros_is_not_used(source: str) -> None:
    both(
        "MOV r7, #9\nJANY LO, a\nMOV r7, #8\na: SAMPLE reset, 0\nJANY LO, b\nOUT 1, r0\n"
        f"b: {source}\nJANY LO, c\nOUT 1, r0\nc: OUT 0, r4\nHALT"
    )


def left(source: str, *, blank: bool = True) -> Counter[str]:
    """How many loads, conversions and so on are left to do."""
    isa = load_isa()
    blocks = build(assemble_text(source, "test.s", MACHINE), MACHINE, isa, Place(0), 999)
    executor = Executor(isa, MACHINE.memory_bytes, blank=blank)
    claims = uniformity(blocks, executor, dict.fromkeys(range(18), SAME))
    while (fewer := unroll(blocks, claims, 999)) is not None:
        blocks, claims = fewer, uniformity(fewer, executor, claims.begins[0])
    use_zeros(blocks, claims, executor)
    found: Counter[str] = Counter()
    for done in claims.summaries:
        for item in done.items if done is not None else ():
            found[item.kind] += not item.needless
    return found


def test_what_is_known_need_not_be_loaded_or_converted() -> None:
    assert left(BEFORE + SOURCES["constant addresses"] + SAVED)["load"] == 1
    assert left(BEFORE + SOURCES["constant addresses"] + SAVED, blank=False)["load"] == 3
    assert left(BEFORE + SOURCES["stored by another name"] + SAVED)["load"] == 0
    assert left(BEFORE + SOURCES["a loop up to the last byte"] + SAVED)["load"] == 0
    # Eight passes are a block, and only in the last of them the address may be that of byte 128.
    assert left(BEFORE + SOURCES["a loop beyond the bank"] + SAVED)["load"] == 1
    assert left(BEFORE + SOURCES["a loop beyond the bank"] + SAVED, blank=False)["load"] == 8
    # Before the loop and in its first pass; later the bank is still as it was.
    frames = BEFORE + SOURCES["a loop of frames"].replace("ST [66]", "ST [32]")
    assert left(frames)["sample"] == 2
    assert left(frames, blank=False)["sample"] == 3
