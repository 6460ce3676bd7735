"""Marks of a run: the paths, predictions and windows that are drawn into its clip.

Programs send the place of one object as ``center_row`` and ``center_col``, or as ``row`` and
``col`` beside ``predicted_row`` and ``predicted_col``, or those of several objects as lists with
their identities in ``id``, the high bytes of which may be in lists such as ``row_high``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from npchip.report.drawing import Mark

if TYPE_CHECKING:
    from collections.abc import Mapping

    from npchip.program.model import Program
    from npchip.run.result import RunResult

Point = tuple[int, int]

CENTER = ("center_row", "center_col")
PLACE = ("row", "col")
PREDICTED = ("predicted_row", "predicted_col")
WINDOW = "SEED"
"""Symbol of a program: half the side of the square about the expected place that it looks into."""
TAIL = 25
"""Last places of each of several objects: whole paths would cover each other."""


class Sight(NamedTuple):
    """An object in one frame: its place, and the one that it is expected at, if any."""

    place: Point
    predicted: Point | None


def has_places(outputs: Mapping[str, object]) -> bool:
    """Return whether a program with these outputs says where something is."""
    return outputs.keys() >= {*CENTER} or outputs.keys() >= {*PLACE, *PREDICTED}


def names_of_places(outputs: Mapping[str, object]) -> set[str]:
    """Return the scalars that the marks show, which need not be written."""
    return {"valid", *CENTER, *PREDICTED, *PLACE} & outputs.keys() if has_places(outputs) else set()


def frames_ahead(outputs: Mapping[str, object], program: Program) -> int:
    """Return how many frames ahead a program predicts; 0 if it predicts nothing."""
    return program.symbols.get("AHEAD", 1) if outputs.keys() >= {*PREDICTED} else 0


def shows_window(program: Program) -> bool:
    """Return whether it is known where the program looks: if it predicts one frame ahead."""
    return WINDOW in program.symbols and program.symbols.get("AHEAD") == 1


def sights(result: RunResult, k: int) -> dict[str, Sight]:
    """Return what frame `k` says, by the name of the object; that of a single one is empty."""
    outputs = result.outputs
    if not has_places(outputs) or ("valid" in outputs and not result.value("valid", k)):
        return {}
    place = CENTER if outputs.keys() >= {*CENTER} else PLACE
    names = (*place, *PREDICTED) if outputs.keys() >= {*PREDICTED} else place
    values = [_value(result, name, k) for name in names]
    if "id" in outputs:
        identities = result.value("id", k) or []
        columns = [value if isinstance(value, list) else [] for value in values]
        rows = zip(identities, *columns, strict=True) if isinstance(identities, list) else ()
        return {str(name): _sight(numbers) for name, *numbers in rows}
    numbers = [value for value in values if isinstance(value, int)]
    return {"": _sight(numbers)} if len(numbers) == len(names) else {}


def marks(result: RunResult, program: Program, k: int) -> tuple[Mark, ...]:
    """Return the marks of frame `k`: of all objects seen; of a single one also where it was."""
    if not has_places(result.outputs):
        return ()
    past = [sights(result, i) for i in range(k + 1)]
    half = program.symbols[WINDOW] if shows_window(program) else None
    drawn = []
    for name in past[k] if "id" in result.outputs else ("",):
        path = [found[name].place for found in past if name in found]
        path = path[-TAIL:] if name else path
        expected = past[k - 1][name].predicted if k and name in past[k - 1] else None
        window = None
        if half and expected:
            row, col = expected
            window = (row - half, col - half, row + half - 1, col + half - 1)
        seen = past[k].get(name, Sight((0, 0), None))
        center = seen.place if name in past[k] else None
        drawn.append(Mark(path, center, seen.predicted, window, name))
    return tuple(drawn)


def _value(result: RunResult, name: str, k: int) -> object:
    """Return a value of frame `k`; that of a list with its high bytes, if there are any."""
    low, high = result.value(name, k), None
    if f"{name}_high" in result.outputs:
        high = result.value(f"{name}_high", k)
    if isinstance(low, list) and isinstance(high, list):
        return [a | b << 8 for a, b in zip(low, high, strict=True)]
    return low


def _sight(numbers: list[int]) -> Sight:
    row, col, *rest = numbers
    return Sight((row, col), (rest[0], rest[1]) if rest else None)
