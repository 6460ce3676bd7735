"""Programs of up to 512 words that are made to take long until they are ready.

Each of them ends soon, so that nearly all of its time is that of the assembler and the compilers.
What nobody writes need not be fast, but it has a bound: such a program is ready within `BOUND_MS`,
or the reference engine runs it and a notice says why.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

BOUND_MS: Final = 1_000

_VARYING: Final = "COL r0\nROW r1\n"
_MASKED: Final = f"{_VARYING}CMP r0, r1\nWHERE NE\n"
_DIRECTIONS: Final = ("north", "east", "south", "west")


def _adc(index: int) -> str:
    return f"ADC r{index * 7 % 16}, r{(index * 5 + 3) % 16}\n"


def _repeat(count: int, line: Callable[[int], str]) -> str:
    return "".join(map(line, range(count)))


def _counted(index: int) -> str:
    """A loop of three instructions whose passes are known."""
    body = _repeat(
        3, lambda k: f"{'RCR' if k else 'ADC'} r{(3 * index + k) % 14}{'' if k else ', r0'}\n"
    )
    return f"MOV r15, #32\nl{index}: {body}SUB r15, #1\nJANY NE, l{index}\n"


def _loop(index: int) -> str:
    """A loop that ends when a sum has left the byte."""
    return f"l{index}: ADC r{2 + index % 14}, r0\nJNONE CS, l{index}\n"


def _branch(index: int) -> str:
    return f"{_adc(index)}JANY EQ, l{index}\nl{index}: "


def _skip(index: int) -> str:
    skipped = f"SBC r{2 + index * 3 % 14}, r0\nADC r{2 + index * 7 % 14}, r1\n"
    return f"{_adc(index)}JANY EQ, l{index}\n{skipped}l{index}: "


def _calls(index: int) -> str:
    return f"a{index}:\n" + f"CALL a{index + 1}\n" * 20 + "RET\n"


PROGRAMS: Mapping[str, str] = {
    "500 carries": _VARYING + _repeat(500, _adc) + "HALT",
    "500 carries, masked": _MASKED + _repeat(500, _adc) + "END\nHALT",
    "250 carries of neighbours": (
        _VARYING
        + _repeat(
            250, lambda k: _adc(k) + f"NBR r{k * 3 % 16}, r{k * 11 % 16}, {_DIRECTIONS[k % 4]}\n"
        )
        + "HALT"
    ),
    "250 branches": _VARYING + _repeat(250, _branch) + "HALT",
    "250 loops": _VARYING + _repeat(250, _loop) + "HALT",
    "250 loops, masked": _MASKED + _repeat(250, _loop) + "END\nHALT",
    "240 loops, masked thrice": (
        f"{_MASKED}CMP r1, #3\nWHERE NE\nCMP r0, #2\nWHERE NE\n"
        + _repeat(240, _loop)
        + "END\nEND\nEND\nHALT"
    ),
    "120 branches around two carries, masked": _MASKED + _repeat(120, _skip) + "END\nHALT",
    "80 counted loops": _VARYING + _repeat(80, _counted) + "HALT",
    "500 exposes": "EXPOSE\n" * 500 + "HALT",
    "500 inputs": "EXPOSE\n" + _repeat(500, lambda k: f"IN r{k % 16}, 0\n") + "HALT",
    "500 sends, masked": (
        f"EXPOSE\n{_MASKED}" + _repeat(500, lambda k: f"OUT 1, r{k % 16}\n") + "END\nHALT"
    ),
    "a routine of 450 carries, called 50 times": (
        _VARYING + "CALL a\n" * 50 + "HALT\na: " + _repeat(450, _adc) + "RET"
    ),
    "450 calls": _VARYING + "CALL a\n" * 450 + "HALT\na: " + _repeat(50, _adc) + "RET",
    "calls of calls of calls": (
        "CALL a0\n" * 20 + "HALT\n" + _repeat(2, _calls) + "a2: ADD r0, #1\nRET"
    ),
}


def beyond(table: Mapping[str, Mapping[str, float]]) -> list[str]:
    """Return the programs that are compiled, but not ready within the bound.

    Args:
        table: by program, ``total ms`` and whether it is ``compiled``.
    """
    return [name for name, row in table.items() if row["compiled"] and row["total ms"] > BOUND_MS]


def shown_bounds(table: Mapping[str, Mapping[str, float]]) -> str:
    """Return how many programs keep the bound and in which way, and those that do not."""
    late, reference = beyond(table), sum(not row["compiled"] for row in table.values())
    in_time = len(table) - reference - len(late)
    kept = f"{in_time} programs are ready within {BOUND_MS:,} ms"
    lines = [f"{kept}, and the reference engine runs {reference} with a notice"]
    return "\n".join([*lines, *(f"error: '{name}' takes longer" for name in late)])
