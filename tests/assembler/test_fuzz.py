"""Whatever the input: a program or diagnostics, soon, and never a traceback.

300 inputs; 10,000 with NPCHIP_PROFILE=thorough; any number with NPCHIP_FUZZ=NUMBER. Input k is
made from the seed k alone, so a failure names all that is needed to have it again.
"""

from __future__ import annotations

import os
import random
import re
import time
from pathlib import Path

import pytest

from npchip.assembler import AssemblyError, assemble, assemble_text, disassemble
from npchip.base.errors import InputError
from npchip.isa import load_isa
from npchip.program.model import Program
from tests.support.profiles import THOROUGH

resource = pytest.importorskip("resource", reason="memory is measured with it")

ROOT = Path(__file__).parents[2]
SHARDS = 8
SECONDS = 20.0  # of computing for one input; the worst usually take one
MEGABYTES = 300  # more than at the most before


def count() -> int:
    if "NPCHIP_FUZZ" in os.environ:
        return int(os.environ["NPCHIP_FUZZ"])
    return 10_000 if THOROUGH else 300


def read(*folders: Path) -> list[bytes]:
    paths = [path for folder in folders for path in sorted(folder.rglob("*.s"))]
    return [path.read_bytes() for path in paths]


GOOD = read(ROOT / "asm")
SEEDS = GOOD + read(ROOT / "tests" / "asm")
assert GOOD
assert len(SEEDS) > 80
TOKEN = re.compile(rb"[A-Za-z_.]\w*|[0-9]\w*|\s+|.", re.DOTALL)
TOKENS = sorted({token for seed in SEEDS for token in TOKEN.findall(seed)})
LINES = sorted({line for seed in SEEDS for line in seed.split(b"\n")})
SPECIAL = [
    *(b"\x00", b"\xff", b"\xef\xbb\xbf", b"\r", b"\x1b[2J", b"\xed\xa0\x80"),
    *("–".encode(), "\N{MATHEMATICAL DOUBLE-STRUCK DIGIT ONE}".encode()),
    *(b"(" * 300, b"-" * 500, b"1" * 40, b"a" * 3000, b"0x", b"''", b'"'),
    *(b".macro m x\nm x + x\n.endm\nm 1\n", b".macro q\n", b".endm\n"),
    *(b".rept 9999\n", b".rept 0\n", b".endr\n", b".if 1\n", b".else\n", b".endif\n"),
    *(b'.include "main.s"\n', b'.include "lib.s"\n', b"; npchip: allow NPW04\n"),
]


def random_bytes(rng: random.Random) -> bytes:
    alphabet = rng.choice(
        [bytes(range(256)), bytes(range(32, 127)) + b"\n\t", b"rR0123#,.[]+-:\n AMDV"]
    )
    return bytes(rng.choices(alphabet, k=rng.randrange(400)))


def often_few(rng: random.Random) -> int:
    return rng.choice([1, 1, 1, 2, 3, 8])


def mutate_bytes(rng: random.Random, data: bytes) -> bytes:
    out = bytearray(data)
    for _ in range(often_few(rng)):
        at = rng.randrange(len(out) + 1)
        kind = rng.randrange(8)
        if kind < 2:
            out[at:at] = bytes([rng.randrange(32, 127)])
        elif kind < 4:
            del out[at : at + rng.randint(1, 8)]
        elif kind < 6:
            out[at : at + 1] = bytes([rng.randrange(32, 127)])
        elif kind == 6 and at < len(out):
            out[at] ^= 1 << rng.randrange(8)
        else:
            out[at:at] = rng.choice(SPECIAL)
    return bytes(out)


def mutate_parts(rng: random.Random, parts: list[bytes], stock: list[bytes]) -> list[bytes]:
    out = list(parts)
    for _ in range(often_few(rng)):
        at = rng.randrange(len(out) + 1)
        other = rng.randrange(len(out) + 1)
        kind = rng.randrange(7)
        if kind == 0:
            out[at:at] = [rng.choice(stock)]
        elif kind == 1:
            del out[at : at + rng.randint(1, 4)]
        elif kind == 2 and at < len(out):
            out[at] = rng.choice(stock)
        elif kind == 3 and at < len(out) and other < len(out):
            out[at], out[other] = out[other], out[at]
        elif kind == 4:
            piece = out[at : at + rng.randint(1, 30)]
            out[other:other] = piece * rng.choice([1, 2, 20])
        elif kind == 5 and at < len(out):
            out[at] = rng.choice(out)
        else:
            out[at:at] = [rng.choice(SPECIAL)]
    return out


def make(seed: int) -> bytes:
    rng = random.Random(seed)
    kind = rng.randrange(10)
    if kind == 0:
        return random_bytes(rng)
    data = rng.choice(rng.choice([GOOD, SEEDS]))
    if kind < 4:
        return mutate_bytes(rng, data)
    if kind < 7:
        return b"".join(mutate_parts(rng, TOKEN.findall(data), TOKENS))
    if kind == 7:  # a splice of two
        data += b"\n" + rng.choice(SEEDS)
    return b"\n".join(mutate_parts(rng, data.split(b"\n"), LINES))


def check_program(program: Program) -> None:
    size = len(program.words)
    assert 0 < size <= 512
    assert len(program.source) == size
    assert all(0 <= word <= 0xFFFF for word in program.words)
    assert all(0 <= address <= size for address in program.labels.values())
    again = assemble_text(disassemble(program, load_isa()))
    assert again.words == program.words
    assert again.labels.keys() >= program.labels.keys()


def check_errors(error: AssemblyError) -> None:
    text = str(error)
    assert 0 < len(error.diagnostics) <= 100
    assert all(char.isprintable() or char in "\n\t" for char in text)
    assert len(text) < 200_000
    for item in error.diagnostics:
        assert item.severity == "error"
        assert re.fullmatch(r"NP0\d\d", item.code)
        assert 0 <= item.span.column <= len(item.span.line.text)
        assert item.message
    keys = [(item.code, item.message, item.span) for item in error.diagnostics]
    assert len(set(keys)) == len(keys)


def run(seed: int, folder: Path) -> str:
    """Assemble input `seed`; returns how it ended."""
    main = folder / "main.s"
    main.write_bytes(make(seed))
    warnings: list[str] = []
    try:
        program = assemble(main, on_warning=lambda item: warnings.append(str(item)))
    except AssemblyError as error:
        check_errors(error)
        return "errors"
    except InputError as error:
        return {"NP025": "unreadable"}[error.code]
    check_program(program)
    return "warnings" if warnings else "program"


def peak() -> int:
    """Return the most memory that this process, with its other tests, has ever had, in MB."""
    most: int = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
    return most


@pytest.mark.parametrize("shard", range(SHARDS))
def test_any_input(shard: int, tmp_path: Path) -> None:
    (tmp_path / "lib.s").write_bytes(b".macro half a\nSHR a, #1\n.endm\n.equ LIMIT, 5\n")
    ends: dict[str, int] = {}
    slowest = (0.0, -1)
    before = peak()
    for seed in range(shard, count(), SHARDS):
        start = time.process_time()
        try:
            end = run(seed, tmp_path)
        except Exception as error:
            raise AssertionError(f"input {seed}: {make(seed)[:2000]!r}") from error
        seconds = time.process_time() - start
        ends[end] = ends.get(end, 0) + 1
        slowest = max(slowest, (seconds, seed))
        assert seconds < SECONDS, f"input {seed} took {seconds:.1f} s"
    megabytes = peak() - before
    if log := os.environ.get("NPCHIP_FUZZ_LOG"):  # what a thorough run has met
        with Path(log).open("a", encoding="utf-8") as stream:
            stream.write(f"{shard} {ends} slowest {slowest} peak +{megabytes} MB\n")
    assert "errors" in ends
    if count() >= 10_000:  # of a few inputs, no shard need have one of every kind
        assert {"program", "unreadable", "warnings"} <= set(ends)
    assert {"program", "warnings"} & set(ends) or sum(ends.values()) < 100
    assert megabytes < MEGABYTES


def test_the_inputs_are_always_the_same() -> None:
    assert [make(seed) for seed in range(20)] == [make(seed) for seed in range(20)]
    assert len({make(seed) for seed in range(200)}) > 150


NAMES = "".join(f".equ label{number}, {number}\n" for number in range(600))


@pytest.mark.long
@pytest.mark.parametrize(
    "text",
    [
        "MOV r0, #" + "(" * 250_000,
        "MOV r0" + "," * 250_000,
        "JMP " + "a" * 250_000,
        "MOV r0, #" + "+".join(["1"] * 80_000),
        ".if 1\n" * 40_000,
        ".if 1\n" * 15_000 + ".endif\n" * 15_000 + "HALT",
        ".rept 9000\n" * 60 + ".endr\n" * 60 + "HALT",
        ".rept 9000\n.if 0\n" + "NOP\n" * 20_000 + ".endif\n.endr\nHALT",
        ".macro m\n" + "NOP\n" * 60_000 + ".endm\n" + "m\n" * 20,
        "".join(f".macro m{i} a\nm{i + 1} a + a\n.endm\n" for i in range(60)) + "m0 1\n",
        "".join(f".equ A{i}, A{i + 1} + 1\n" for i in range(9_000)) + "HALT",
        "".join(f"a{i}: CALL a{i + 1}\n" for i in range(510)) + "a510: RET\n",
        NAMES + "JMP labex\n" * 10_000,
        NAMES + ".rept 6000\n.if labex\n.endif\n.endr\n",
        ".rept 9000\nFOOP 1\nblip\n.endr\n",
        '.rept 9000\n.include "missing.s"\n.endr\n',
        "WHERE EQ\n" * 19_000,
        "a: NOP\n" * 19_000,
    ],
    ids=lambda text: re.sub(r"\W+", "_", text[:24]),
)
def test_large_inputs_end_soon(text: str) -> None:
    start = time.process_time()
    try:
        assemble_text(text, on_warning=lambda _: None)
    except AssemblyError as error:
        check_errors(error)
    assert time.process_time() - start < SECONDS
