"""Memory that is known to be 0 after the reset level was converted: what that is used for."""

from __future__ import annotations

import pytest

from tests.engines.wasm.test_engine import both
from tests.support.chips import machine_of
from tests.support.compiled import compiled

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


def size(source: str) -> int:
    """Return the bytes of the module of a source behind `BEFORE`."""
    return compiled(BEFORE + source + SAVED, MACHINE).size


@pytest.mark.parametrize(
    ("source", "same"),
    [
        ("LD r5, [64]\nADD r6, r5", "MOV r5, #0\nADD r6, r5"),
        ("LD r5, [127]\nADD r6, r5", "MOV r5, #0\nADD r6, r5"),
        ("MOV r3, #6\nST [r3 + 64], r1\nLD r5, [71]", "MOV r3, #6\nST [r3 + 64], r1\nMOV r5, #0"),
        ("MOV r3, #6\nST [r3 + 64], r1\nLD r5, [70]", "MOV r3, #6\nST [r3 + 64], r1\nMOV r5, r1"),
    ],
)
def test_a_load_of_what_is_known_costs_as_little_as_a_constant(source: str, same: str) -> None:
    assert size(source) == size(same)


def test_a_load_of_what_is_not_known_costs_more() -> None:
    source = "LD r5, [{}]\nADD r6, r5"
    assert size(source.format(127)) < size(source.format(128))
    # Eight passes are a block, and only in the last of them the address may be that of byte 128.
    inside, over, behind = (size(LOOP.format(first=first, end=first + 64)) for first in (0, 1, 64))
    assert inside < over < behind
    assert 7 * (over - inside) < behind - over


STORES = {
    "to another constant address": ("ST [70], r1\nST [71], r2\n", "[70]"),
    "to the address of the same register in another bank": (
        "ST [r3 + 64], r1\nST [r3 + 128], r2\n",
        "[r3 + 64]",
    ),
    "of the same byte as before": ("ST [70], r2\nST [70], r1\n", "[70]"),
}


@pytest.mark.parametrize("name", STORES)
def test_a_byte_that_was_stored_is_not_read_again_behind_a_store(name: str) -> None:
    stores, address = STORES[name]
    begin = "COL r1\nROW r2\nCOL r3\n"
    assert size(f"{begin}{stores}LD r5, {address}") == size(f"{begin}{stores}MOV r5, r1")


@pytest.mark.parametrize("address", ["[r4 + 0]", "[r3 + 0]"])
def test_a_byte_is_read_again_where_a_store_may_have_changed_it(address: str) -> None:
    begin = f"COL r1\nROW r2\nCOL r3\nROW r4\nST [70], r1\nST {address}, r2\n"
    assert size(f"{begin}LD r5, [70]") != size(f"{begin}MOV r5, r1")
    both(f"{BEFORE}{begin}LD r5, [70]{SAVED}")
