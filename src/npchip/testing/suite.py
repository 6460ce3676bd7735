"""The parser of test lines: ``; run:``, ``; expect:`` and ``; mistake:`` in a source."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from npchip.assembler.diagnostics import AssemblyError, Line, Note, SourceError, Span, did_you_mean
from npchip.assembler.expressions import COMPARISONS
from npchip.assembler.lexer import read_number
from npchip.assembler.sources import read_source
from npchip.testing.claims import Claim, GoldenClaim, Mistake, parse_claim, parse_mistake

MAX_CYCLES = 1_000_000
"""Default limit for the cycles of one frame, low enough to end an endless loop in seconds."""

MAIN = "main"
"""Name of the run in a source without ``; run:`` lines."""

KEYS = (
    "frames",
    "levels",
    "first",
    "fit",
    "machine",
    "define",
    "memory",
    "partner",
    "partner-frames",
    "max-cycles",
)
_FITS = ("crop", "resize")


@dataclass
class Run:
    """A ``; run:`` line with the expectations that belong to it.

    Attributes:
        span: place of its name.
        frames: the clip, as written, relative to the source; None without.
        levels: grey levels instead of a clip, one uniform frame for each.
        first: largest number of frames to take.
        fit: ``crop`` or ``resize`` frames of another size.
        machines: names or files, as written.
        defines: values for ``.equ`` constants.
        memory: pairs of address and file, as written: initial memory of the NPs.
        partner: program of another camera that sends to this one, as written; None without.
        partner_frames: the clip of the partner.
        max_cycles: limit for the cycles of one frame.
        claims: the expectations; those above the first ``; run:`` line come first.
        mistakes: known mistakes, likewise.
    """

    name: str
    span: Span
    frames: str | None = None
    levels: tuple[int, ...] | None = None
    first: int | None = None
    fit: str | None = None
    machines: tuple[str, ...] = ("default",)
    defines: dict[str, int] = field(default_factory=dict)
    memory: list[tuple[int, str]] = field(default_factory=list)
    partner: str | None = None
    partner_frames: str | None = None
    max_cycles: int = MAX_CYCLES
    claims: list[Claim | GoldenClaim] = field(default_factory=list)
    mistakes: list[Mistake] = field(default_factory=list)

    @property
    def golden_outputs(self) -> bool:
        """True if status and outputs must equal the golden."""
        return any(isinstance(claim, GoldenClaim) and claim.outputs for claim in self.claims)

    @property
    def golden_cycles(self) -> bool:
        """True if words, instructions and cycles must equal the golden."""
        return any(isinstance(claim, GoldenClaim) and claim.cycles for claim in self.claims)


@dataclass(frozen=True)
class Suite:
    """The runs of a source.

    Attributes:
        path: the source.
        runs: its runs in order; one named ``main`` if it has expectations only.
        kinds: kinds of the outputs that it declares itself, by name.
    """

    path: Path
    runs: tuple[Run, ...]
    kinds: dict[str, str] = field(default_factory=dict)


def read_suite(path: Path) -> Suite:
    """Read the test lines of a source, and ignore the program.

    Raises:
        InputError: NP025, the file cannot be read.
        AssemblyError: all mistakes. NP270, in an expectation; NP271, in a run; NP272, two runs of
            one name.
    """
    return parse_suite(read_source(path), path)


def parse_suite(text: str, path: Path) -> Suite:
    """Read the test lines in the text of a source; raises as `read_suite`."""
    runs: dict[str, Run] = {}
    common: list[Claim | GoldenClaim] = []
    known: list[Mistake] = []
    current: Run | None = None
    mistakes = []
    for number_, content in enumerate(text.split("\n"), start=1):
        line = Line(str(path), number_, content.rstrip("\r"))
        try:
            match = _directive(line)
            if match is None:
                continue
            if match["word"] == "expect":
                claim = parse_claim(line, match.end())
                (current.claims if current else common).append(claim)
            elif match["word"] == "mistake":
                mistake = parse_mistake(line, match.end())
                (current.mistakes if current else known).append(mistake)
            else:
                current = _parse_run(line, match.end())
                _check_name(current, runs.setdefault(current.name, current))
        except SourceError as error:
            mistakes.append(error.diagnostic)
    if mistakes:
        raise AssemblyError(mistakes)
    if common and not runs:
        runs[MAIN] = Run(MAIN, common[0].span)
    for run in runs.values():
        run.claims = [*common, *run.claims]
        run.mistakes = [*known, *run.mistakes]
    return Suite(path, tuple(runs.values()), output_kinds(text))


def output_kinds(text: str) -> dict[str, str]:
    """Return the kinds of the outputs that the text of a source declares, by name."""
    return {found["name"]: found["kind"].lower() for found in _OUTPUT.finditer(text)}


def _check_name(run: Run, first: Run) -> None:
    if run is not first:
        note = Note("first run of this name", first.span)
        message = f"a run named '{run.name}' is already there"
        raise SourceError("NP272", message, run.span, note)


_OUTPUT = re.compile(
    r"^\s*\.output\s+(?P<name>\w+)\s*,[^,;\n]*,\s*(?P<kind>\w+)", re.MULTILINE | re.IGNORECASE
)
_COMMENT = re.compile(
    r"""(?:[^;"']|"[^"]*"|'(?:\\.|[^'\\])'|"(?![^"]*")|'(?!(?:\\.|[^'\\])'))*?;+"""
)
_KINDS = ("expect", "run", "mistake")
_WORD = re.compile(r"\s*(?P<word>[A-Za-z]+)\s*(?P<colon>:)?")
_RUN_LIKE = re.compile(rf"\s*[\w.-]+\s+(?:{'|'.join(KEYS)})\s*=")


def _directive(line: Line) -> re.Match[str] | None:
    """Return the match of a test line; None for other comments.

    Raises:
        SourceError: NP270, the comment looks like a misspelt test line.
    """
    comment = _COMMENT.match(line.text)
    word = _WORD.match(line.text, comment.end()) if comment else None
    if word is None:
        return None
    if word["colon"] and word["word"] in _KINDS:
        return word
    near = get_close_matches(word["word"].lower(), _KINDS, n=1, cutoff=0.8)
    if not word["colon"] and word["word"] not in near:
        return None  # "; expects r0 < 64" is an ordinary comment
    rest = line.text[word.end() :]
    looks_like = _RUN_LIKE.match(rest) if near == ["run"] else any(op in rest for op in COMPARISONS)
    if near and looks_like:
        span = Span(line, word.start("word"), len(word["word"]))
        message = f"'{word[0].strip()}' begins neither a run nor an expectation"
        raise SourceError("NP270", message, span, suggestion=f"did you mean '{near[0]}:'?")
    return None


_ITEM = re.compile(
    r"""\s*(?:
      (?P<end>;|$)
    | (?P<key>[A-Za-z_][\w-]*)\s*=\s*(?:"(?P<quoted>[^"]*)"|(?P<value>[^\s;"]*))(?=\s|;|$)
    | (?P<name>[\w.-]+)(?=\s|;|$)
    | (?P<other>\S+)
    )""",
    re.VERBOSE,
)


def _parse_run(line: Line, start: int) -> Run:
    items = _ITEM.finditer(line.text, start)
    item = next(items)
    kind, span = _kind(item, line)
    if kind != "name":
        shown = "the end of the line" if kind == "end" else f"'{item[0].strip()}'"
        hint = "such as: ; run: coin frames=coin.npy"
        raise _wrong(f"expected a name for the run, found {shown}", span, hint)
    run = Run(item["name"], span)
    seen: set[str] = set()
    for item in items:
        kind, span = _kind(item, line)
        if kind == "end":
            break
        if kind != "key":
            hint = f'keys are {", ".join(KEYS)}; put a value with blanks in "quotes"'
            raise _wrong(f"expected KEY=VALUE, found '{item[0].strip()}'", span, hint)
        if item["key"] in seen - {"define", "memory"}:
            raise _wrong(f"'{item['key']}' is given twice", span)
        seen.add(item["key"])
        _set(run, item["key"], item["quoted"] or item["value"] or "", span)
    if {"frames", "levels"} <= seen:
        raise _wrong("frames and levels exclude each other", run.span)
    if (run.partner is None) != (run.partner_frames is None):
        raise _wrong("partner and partner-frames need each other", run.span)
    return run


def _kind(item: re.Match[str], line: Line) -> tuple[str, Span]:
    kind = "key" if item["key"] else item.lastgroup or "end"
    return kind, Span(line, item.start(kind), max(1, item.end() - item.start(kind)))


def _wrong(message: str, span: Span, hint: str | None = None) -> SourceError:
    return SourceError("NP271", message, span, suggestion=hint)


def _set(run: Run, key: str, value: str, span: Span) -> None:
    def wrong(expected: str) -> SourceError:
        found = f"'{value}'" if value else "nothing"
        return _wrong(f"{key}: expected {expected}, found {found}", span)

    match key:
        case "frames" | "partner" | "partner-frames":
            if not value:
                clip = "a clip such as coin.npy"
                other = "a file such as sighting.s, or a clip such as right.npy"
                raise wrong(clip if key == "frames" else other)
            setattr(run, key.replace("-", "_"), value)
        case "levels":
            levels = [read_number(each) for each in value.split(",")]
            if any(level is None or not 0 <= level <= 255 for level in levels):
                raise wrong("grey levels from 0 to 255 such as 0,128,255")
            run.levels = tuple(level for level in levels if level is not None)
        case "first" | "max-cycles":
            count = read_number(value)
            if count is None or count < 1:
                raise wrong("a whole number from 1 on")
            setattr(run, key.replace("-", "_"), count)
        case "fit":
            if value not in _FITS:
                raise wrong("crop or resize")
            run.fit = value
        case "machine":
            run.machines = tuple(value.split(","))
            if not all(run.machines) or len(set(run.machines)) < len(run.machines):
                raise wrong("different machines such as default,conservative")
        case "define":
            name, _, digits = value.partition("=")
            setting = read_number(digits)
            if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII) or setting is None:
                raise wrong("NAME=NUMBER such as THRESHOLD=24")
            if name in run.defines:
                raise _wrong(f"{name} is defined twice", span)
            run.defines[name] = setting
        case "memory":
            address, _, file = value.partition("=")
            place = read_number(address)
            if place is None or place < 0 or not file:
                raise wrong("ADDRESS=FILE such as 0xC0=weights.npy")
            run.memory.append((place, file))
        case _:
            message = f"a run has no '{key}': it has {', '.join(KEYS)}"
            raise _wrong(message, span, did_you_mean(key, KEYS))
