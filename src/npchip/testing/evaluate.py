"""Checks claims against a program and a result."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any, Literal, NamedTuple

from npchip.assembler.diagnostics import SourceError, did_you_mean
from npchip.assembler.expressions import COMPARISONS, Op
from npchip.program.model import OUTPUT_FORMS, OUTPUT_KINDS, PORTS, Program
from npchip.run.result import FrameRecord, Measured
from npchip.testing.claims import Claim, Range, Wanted
from npchip.testing.compare import frame_name, shown

PER_FRAME = ("cycles", "instructions")
SINGLE = ("words", "frames")
WORDS = ("status", "error")
MEASURES = (*PER_FRAME, *SINGLE, *WORDS)
STATUSES = ("halted", "frames-exhausted", "cycle-limit", "failed")

_ITEMS = 12

Frame = int | Literal["setup", "total"]


class _NothingError(Exception):
    """There is no value to compare; the text says why."""


# ---- before a run


def check_claim(claim: Claim, program: Program) -> None:
    """Refuse a claim that makes no sense for a program.

    Raises:
        SourceError: NP273, there is no such output; NP274, the comparison makes no sense for it.
    """
    kinds = {f"port{n}": "plane" for n in range(PORTS)}
    kinds |= {output.name: output.kind for output in program.outputs}
    named = {output.name for output in program.outputs}
    if claim.name in MEASURES:
        if claim.name in named:
            message = f"'{claim.name}' is a measure of every run, and an output of {program.name}"
            raise SourceError("NP274", message, claim.name_span, suggestion="rename the output")
        kind = claim.name
    elif claim.name in kinds:
        kind = kinds[claim.name]
    else:
        known = ", ".join(output.name for output in program.outputs) or "none"
        raise SourceError(
            "NP273",
            f"{program.name} has no output '{claim.name}'",
            claim.name_span,
            suggestion=did_you_mean(claim.name, [*named, *MEASURES]) or f"its outputs: {known}",
        )
    _check_kind(claim, kind)


def misfit(claim: Claim, program: Program, wanted: str | None = None) -> str | None:
    """Return why a submission cannot be asked for a claim that others can fulfil.

    Args:
        claim: a claim of the exercise.
        program: the submission.
        wanted: kind of the output in the exercise; None if that does not say.

    Raises:
        SourceError: no program could fulfil the claim, which is a mistake of the exercise.
    """
    kind = next((each.kind for each in program.outputs if each.name == claim.name), None)
    if kind and wanted and _form(wanted) != _form(kind):
        return _other_kind(claim, kind, [wanted])
    try:
        check_claim(claim, program)
    except SourceError as error:
        if claim.name in MEASURES and not kind:
            raise
        fitting = [each for each in OUTPUT_KINDS if _fits(claim, each)]
        if not fitting:
            raise
        if kind and claim.name not in MEASURES:
            return _other_kind(claim, kind, fitting)
        said = error.diagnostic
        return f"{said.message} ({said.suggestion})" if said.suggestion else said.message
    return None


def _other_kind(claim: Claim, kind: str, wanted: Sequence[str]) -> str:
    return f"'{claim.name}' is a {kind}, expected a {' or '.join(wanted)}"


def _fits(claim: Claim, kind: str) -> bool:
    try:
        _check_kind(claim, kind)
    except SourceError:
        return False
    return True


def _check_kind(claim: Claim, kind: str) -> None:
    _check_place(claim, kind)
    for value in claim.values:
        _check_value(claim, kind, value)


def _check_place(claim: Claim, kind: str) -> None:
    array, items = _form(kind) == "array", _form(kind) == "list"
    if kind in {*SINGLE, *WORDS} and (claim.frames is not None or claim.function):
        raise _senseless(claim, f"'{claim.name}' is one value for the whole run")
    if claim.frames in {"total", "worst"} and kind not in PER_FRAME:
        raise _senseless(claim, f"[{claim.frames}] is for {' and '.join(PER_FRAME)}")
    if claim.element and len(claim.element) != (2 if array else 1 if items else 0):
        wanted = "[row, column]" if array else "[item]" if items else "no second bracket"
        raise _senseless(claim, f"'{claim.name}' is a {kind}: expected {wanted}")
    if claim.function and (not (array or items) or (items and claim.element)):
        raise _senseless(claim, f"{claim.function}() is for lists, planes and pictures")
    several = claim.frames in {None, "all"} or (
        isinstance(claim.frames, Range) and claim.frames.first != claim.frames.last
    )
    if len(claim.values) > 1 and not several:
        raise _senseless(claim, f"{len(claim.values)} values for one frame", "lists: [1, 2, 3]")


def _form(kind: str) -> str | None:
    """Return the form of a frame's value; None for a measure."""
    return next((form for name, form in OUTPUT_FORMS.items() if name == kind), None)


def _check_value(claim: Claim, kind: str, value: Wanted) -> None:
    equality = claim.op in {"==", "!="}
    if kind in WORDS:
        if value is None and kind == "error":
            return
        if not isinstance(value, str) or not equality:
            example = "status == halted" if kind == "status" else "error == NP310"
            raise _senseless(claim, f"'{kind}' is a word", f"such as {example}")
        if kind == "status" and value not in STATUSES:
            near = did_you_mean(value, STATUSES)
            raise _senseless(claim, f"a status is one of {', '.join(STATUSES)}", near)
        return
    if isinstance(value, str):
        near = did_you_mean(value, ["null"])
        raise _senseless(claim, f"expected a number, found '{value}'", near)
    whole_list = _form(kind) == "list" and not claim.function and not claim.element
    if isinstance(value, tuple) and not whole_list:
        raise _senseless(claim, "only a whole list output is compared with [a, list]")
    if whole_list and isinstance(value, int | Range):
        hint = f"one item: {claim.name}[0][2], or len(), min(), max(), sum()"
        raise _senseless(claim, f"'{claim.name}' is a list: compare it with [a, list]", hint)
    if not isinstance(value, int) and not equality:
        raise _senseless(claim, f"{shown(value)} is compared with == or !=")


def _senseless(claim: Claim, message: str, suggestion: str | None = None) -> SourceError:
    return SourceError("NP274", message, claim.span, suggestion=suggestion)


# ---- after a run


def fault(claim: Claim, result: Measured, program: Program) -> str | None:
    """Return what was found, as text, if the claim does not hold; None if it holds."""
    if claim.name in {*SINGLE, *WORDS}:
        return _fault_of_run(claim, result, program)
    try:
        frames = _frames(claim, result)
    except _NothingError as reason:
        return str(reason)
    values = claim.values * len(frames) if len(claim.values) == 1 else claim.values
    if len(values) != len(frames):
        return f"{len(values)} values for {len(frames)} frames"
    faults: list[tuple[Frame, str]] = []
    for frame, value in zip(frames, values, strict=True):
        try:
            said = _fault_of_value(_found(claim, result, frame), claim, value)
        except _NothingError as reason:
            said = str(reason)
        if said is not None:
            faults.append((frame, said))
    if claim.frames == "any":
        if len(faults) < len(frames):
            return None
        several = ", ".join(said for _, said in faults[:_ITEMS])
        return f"in no frame; found {several}{', ...' if len(faults) > _ITEMS else ''}"
    if not faults:
        return None
    frame, said = faults[0]
    where = f" in {frame_name(frame)}" if len(frames) > 1 or claim.frames == "worst" else ""
    more = len(faults) - 1
    rest = f" (and {more} more frame{'s' * (more > 1)})" if more else ""
    instead = f", not {shown(values[frames.index(frame)])}" if len(claim.values) > 1 else ""
    return f"found {said}{where}{instead}{rest}"


def _fault_of_run(claim: Claim, result: Measured, program: Program) -> str | None:
    found: Any = {
        "words": len(program.words),
        "frames": result.frames,
        "status": result.status,
        "error": result.error.code if result.error else None,
    }[claim.name]
    if claim.name in WORDS:
        same = COMPARISONS[claim.op](found, claim.values[0])
        remark = f": {result.error.message}" if result.error else ""
        return None if same else f"found {shown(found)}{remark}"
    said = _fault_of_value(found, claim, claim.values[0])
    return None if said is None else f"found {said}"


def _frames(claim: Claim, result: Measured) -> Sequence[Frame]:
    wanted, count = claim.frames, result.frames
    if wanted == "setup" or (wanted is None and not count):
        return ["setup"]
    if wanted == "total":
        return ["total"]
    if not count:
        raise _NothingError("the run has no frames")
    if wanted == "worst":
        column = _column(claim.name, result)
        return [max(range(count), key=column.__getitem__)]
    if not isinstance(wanted, Range):
        return range(count)
    ends = wanted.first, _or(wanted.last, count - 1)
    first, last = (at + count if at < 0 else at for at in ends)
    if not 0 <= first <= last < count:
        frames = f"{count} frame{'s' * (count != 1)}"
        raise _NothingError(f"there is no frame {shown(wanted)}: the run has {frames}")
    return range(first, last + 1)


def _or(value: int | None, other: int) -> int:
    return other if value is None else value


def _column(name: str, result: Measured) -> Any:
    return result.frame_cycles if name == "cycles" else result.frame_instructions


class _Numbers(NamedTuple):
    """Values that are compared one by one: those of an array, or some items of a list.

    Attributes:
        extents: their number in each direction.
        values: the values, row after row.
        first: index of the first one in the whole value.
    """

    extents: tuple[int, ...]
    values: list[int]
    first: tuple[int, ...]

    def __str__(self) -> str:
        return f"{' x '.join(map(str, self.extents))} values"

    def place(self, index: int) -> str:
        """Return the index of one of the values in the whole, as text."""
        inside = divmod(index, self.extents[1]) if len(self.extents) > 1 else (index,)
        return ", ".join(str(a + b) for a, b in zip(inside, self.first, strict=True))


def _found(claim: Claim, result: Measured, frame: Frame) -> Any:
    """Return the left side of a claim in one frame."""
    if claim.name in PER_FRAME:
        if frame == "total":
            return getattr(result, claim.name)
        record: FrameRecord = result.setup
        setup = getattr(record, claim.name)
        return setup if frame == "setup" else int(_column(claim.name, result)[frame])
    assert frame != "total"
    if frame == "setup":
        value: Any = result.setup.outputs.get(claim.name)
    else:
        value = result.value(claim.name, frame) if claim.name in result.outputs else None
    value = _plain(value)
    if value is None and (claim.element or claim.function):
        raise _NothingError("null")
    if claim.element:
        value = _element(claim, value)
    return _apply(claim.function, value) if claim.function else value


def _plain(value: Any) -> int | list[int] | _Numbers | None:
    """Return an array, or the list of its rows, as numbers; another value as it is."""
    rows = value if value is None or isinstance(value, int | list) else value.tolist()
    if isinstance(rows, list) and rows and isinstance(rows[0], list):
        return _Numbers((len(rows), len(rows[0])), [*chain.from_iterable(rows)], (0, 0))
    return rows


def _element(claim: Claim, value: list[int] | _Numbers) -> int | _Numbers:
    extents = value.extents if isinstance(value, _Numbers) else (len(value),)
    parts: list[range] = []
    for part, extent in zip(claim.element, extents, strict=True):
        last = _or(part.last, extent - 1)
        if not part.first <= last < extent:
            size = " x ".join(map(str, extents))
            what = f"{size} pixels" if len(extents) == 2 else f"{size} item{'s' * (extent != 1)}"
            place = ", ".join(map(shown, claim.element))
            raise _NothingError(f"no [{place}], as it has {what}")
        parts.append(range(part.first, last + 1))
    if isinstance(value, list):
        (items,) = parts
        if len(items) == 1:
            return value[items[0]]
        picked = [value[at] for at in items]
    else:
        rows, cols = parts
        width = extents[1]
        picked = [value.values[row * width + col] for row in rows for col in cols]
    return _Numbers(tuple(map(len, parts)), picked, tuple(part[0] for part in parts))


def _apply(function: str, value: Any) -> int:
    items = value.values if isinstance(value, _Numbers) else value
    if function == "len":
        return len(items)
    if function == "sum":
        return sum(items)
    if not items:
        raise _NothingError("an empty list")
    return min(items) if function == "min" else max(items)


def _fault_of_value(found: Any, claim: Claim, value: Wanted) -> str | None:
    """Return `found` as text if the comparison fails; None if it holds."""
    if value is None or found is None:
        holds = (found is value) == (claim.op == "==") and claim.op in {"==", "!="}
        return None if holds else str(found) if isinstance(found, _Numbers) else shown(found)
    if isinstance(found, _Numbers):
        wrong = {number for number in {*found.values} if not compares(number, claim.op, value)}
        if not wrong:
            return None
        at = next(index for index, number in enumerate(found.values) if number in wrong)
        element = found.values[at]
        return str(element) if len(found.values) == 1 else f"{element} at [{found.place(at)}]"
    if isinstance(found, list):
        found = tuple(found)
    return None if compares(found, claim.op, value) else shown(found)


def compares(found: Any, op: Op, value: Wanted) -> bool:
    """Return whether a number compares with a wanted one, or with a range, as it should."""
    if isinstance(value, Range):
        assert value.last is not None
        return bool(value.first <= found <= value.last) == (op == "==")
    return bool(COMPARISONS[op](found, value))
