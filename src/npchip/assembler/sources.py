"""Source files: read within limits, with the files they include and their allow comments."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import NamedTuple

from npchip import bundle
from npchip.assembler.blocks import Node, parse
from npchip.assembler.codes import WARNINGS
from npchip.assembler.diagnostics import (
    Diagnostic,
    Line,
    SourceError,
    Span,
    did_you_mean,
    nearest,
    quoted,
)
from npchip.assembler.lexer import Kind, Token, tokenize
from npchip.base.errors import InputError
from npchip.base.files import open_input

MAX_BYTES = 1 << 18
"""Most bytes of a source with its included files: ten times a full program."""

_COMMENT = re.compile(r";+\s*npchip:\s*(?P<word>\w*)\s*(?P<rest>.*)")
_CODE = re.compile(r"(?P<code>NPW?\w+)[\s,:]*", re.IGNORECASE)

Report = Callable[[Diagnostic], None]


class Allow(NamedTuple):
    """A comment ``; npchip: allow NPW04 REASON``: it allows warnings in its line."""

    line: Line
    span: Span
    codes: tuple[str, ...]


class SourceFile(NamedTuple):
    """A file as a tree of lines and blocks.

    Attributes:
        name: the file's name in messages.
        path: the file with symbolic links resolved; None for a text that is no file.
        first: the first line.
        nodes: the lines and blocks.
        doubtful: True if an error in the blocks may have lost definitions.
        macros: names of the macros that the file defines anywhere.
    """

    name: str
    path: Path | None
    first: Line
    nodes: list[Node]
    doubtful: bool
    macros: frozenset[str]


def split_lines(text: str) -> list[str]:
    """Return the lines of a text as editors count them: unlike `str.splitlines`, no form feeds."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


class Sources:
    """The files of one assembly.

    Args:
        include_paths: folders besides the source's own from which ``.include`` may take files.
        texts: texts that stand for files, as an editor has them before they are saved; the paths
            have their symbolic links resolved.

    Attributes:
        files: the files by name, in the order of reading.
        order: number of each file in that order.
        allows: comments that allow warnings.
        unread: errors within lines, and how to report each: only if the line is not left out.
    """

    def __init__(
        self, include_paths: Sequence[Path], texts: Mapping[Path, str] = MappingProxyType({})
    ) -> None:
        self.include_paths = include_paths
        self.texts = texts
        self.files: dict[str, SourceFile] = {}
        self.order: dict[str, int] = {}
        self.allows: list[Allow] = []
        self.unread: list[tuple[Diagnostic, Report]] = []
        self._failed: dict[tuple[str, str], SourceError] = {}
        self._bytes = 0

    def add(self, text: str, name: str, path: Path | None, report: Report) -> SourceFile:
        """Add a file with this text, and report errors in its tokens and blocks."""
        self.order.setdefault(name, len(self.order))
        lines = [Line(name, number, part) for number, part in enumerate(split_lines(text), 1)]
        tokens: list[list[Token]] = []

        def later(diagnostic: Diagnostic) -> None:
            self.unread.append((diagnostic, report))

        def at_once(diagnostic: Diagnostic) -> None:
            (later if diagnostic.code == "NP004" else report)(diagnostic)

        for line in lines:
            found = tokenize(line, later)
            if "npchip:" in found[-1].text:
                try:
                    self.allows += filter(None, [_parse_allow(found[-1])])
                except SourceError as error:
                    later(error.diagnostic)
            if found[0].kind is not Kind.END:
                tokens.append(found)
        nodes, doubtful = parse(tokens, at_once)
        macros = frozenset(
            line[1].text
            for line in tokens
            if line[0].text.lower() == ".macro" and line[-1].kind is not Kind.BROKEN
        )
        self.files[name] = SourceFile(name, path, lines[0], nodes, doubtful, macros)
        return self.files[name]

    def include(self, wanted: str, token: Token, report: Report) -> SourceFile:
        """Return the file that an ``.include`` names; a file is read once.

        Args:
            wanted: the path as written, relative to the file that holds `token`.
            token: the token of the path.
            report: is called with each error in the file.

        Raises:
            SourceError: NP027 it cannot be read, NP028 it lies outside the allowed folders.
        """
        key = (wanted, token.line.file)
        if key in self._failed:
            raise self._failed[key].with_traceback(None)
        try:
            return self._find(wanted, token, report)
        except SourceError as error:
            self._failed[key] = error
            raise

    def data(self, wanted: str, token: Token) -> Path:
        """Return where a file of bytes lies, with symbolic links resolved; it need not be there.

        Args:
            wanted: the path as written, relative to the file that holds `token`.
            token: the token of the path.

        Raises:
            SourceError: NP027 there is no folder, NP028 it lies outside the allowed folders.
        """
        inside, outside = self._candidates(wanted, token)
        for path, _ in inside:
            if _mode(path) is not None:
                return path
        if not inside:
            raise self._outside(wanted, token) if outside else self._missing(wanted, token, ())
        return inside[0][0]

    def _find(self, wanted: str, token: Token, report: Report) -> SourceFile:
        inside, outside = self._candidates(wanted, token)
        for real, shown in inside:
            if _mode(real) is not None:
                name = shown.as_posix()
                return self.files.get(name) or self._read(real, name, token, report)
        if outside:
            raise self._outside(wanted, token)
        raise self._missing(wanted, token, [path for path, _ in inside])

    def _candidates(self, wanted: str, token: Token) -> tuple[list[tuple[Path, Path]], bool]:
        """Return places where a file may lie, resolved and as shown; and whether others do not."""
        main, *_ = self.files.values()
        includer = self.files[token.line.file]
        trees = [Path(os.path.realpath(folder)) for folder in self.include_paths]
        candidates = [(folder / wanted, folder / wanted) for folder in self.include_paths]
        if includer.path and main.path:
            trees.append(main.path.parent)
            shown = PurePath(includer.name).parent / wanted
            candidates.insert(0, (includer.path.parent / wanted, Path(shown)))
        resolved = [(Path(os.path.realpath(path)), shown) for path, shown in candidates]
        inside = [
            (real, shown)
            for real, shown in resolved
            if any(real.is_relative_to(tree) for tree in trees)
        ]
        return inside, len(inside) < len(resolved)

    def _outside(self, wanted: str, token: Token) -> SourceError:
        message = f"{quoted(wanted)} lies outside the folder of the source"
        hint = "name its folder as an include path: -I FOLDER"
        return SourceError("NP028", message, token.span, suggestion=hint)

    def _missing(self, wanted: str, token: Token, tried: Sequence[Path]) -> SourceError:
        hint = None
        if not tried:
            hint = "a text that is no file has no folder: name one as an include path"
        for path in tried:
            with suppress(OSError):
                siblings = {item.name for item in path.parent.iterdir()}
                siblings.discard(Path(token.line.file).name)
                near = nearest(path.name, sorted(siblings))
                if near and hint is None:
                    hint = f"did you mean {PurePath(wanted).with_name(near).as_posix()}?"
        return SourceError("NP027", f"no such file: {quoted(wanted)}", token.span, suggestion=hint)

    def _read(self, path: Path, name: str, token: Token, report: Report) -> SourceFile:
        if not stat.S_ISREG(_mode(path) or 0):  # a named pipe would wait for ever
            raise SourceError("NP027", f"{quoted(token.text[1:-1])} is not a file", token.span)
        try:
            text = read_source(path, name, MAX_BYTES - self._bytes, self.texts)
        except InputError as error:
            code = "NP027" if error.code == "NP025" else error.code
            raise SourceError(code, error.message, token.span, suggestion=error.hint) from None
        self._bytes += len(text)
        return self.add(text, name, path, report)


def _mode(path: Path) -> int | None:
    """Return kind and permissions of a file, or None if there is no such file."""
    try:
        return path.stat().st_mode
    except OSError:
        return None


def read_source(
    path: Path,
    name: str | None = None,
    limit: int = MAX_BYTES,
    texts: Mapping[Path, str] = MappingProxyType({}),
) -> str:
    """Return the text of a source file, which messages about its encoding call `name`.

    Args:
        path: the file.
        name: its name in messages about its encoding.
        limit: most bytes.
        texts: as for `Sources`.

    Raises:
        InputError: NP025 it cannot be read, is longer than `limit` bytes, or is not UTF-8.
    """
    if path in texts:
        data = texts[path].encode(errors="replace")
        return _decoded(data, path, name, limit)
    try:
        with open_input(path) as stream:
            data = stream.read(limit + 1)
    except OSError as error:
        hint = bundle.hint("program", path) if isinstance(error, FileNotFoundError) else None
        if isinstance(error, IsADirectoryError) or path.is_dir():
            hint = _within(path)
        message = f"cannot read {path}: {error.strerror or error}"
        raise InputError("NP025", message, hint=hint) from None
    return _decoded(data, path, name, limit)


def _within(folder: Path) -> str | None:
    """Return a hint at the source in a folder: the one of its name, or the only one."""
    own = folder / f"{folder.absolute().name}.s"
    with suppress(OSError):
        found = [own] if own.is_file() else sorted(folder.glob("*.s"))
        if len(found) == 1:
            return f"did you mean {found[0]}?"
    return None


def _decoded(data: bytes, path: Path, name: str | None, limit: int) -> str:
    if len(data) > limit:
        kib = MAX_BYTES >> 10
        raise InputError("NP025", f"{path}: more than {kib} KiB of source: this is no program")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            "NP025",
            f"{name or path}: not UTF-8 text (line {line}, byte 0x{data[error.start]:02X})",
            hint="save it with the encoding UTF-8; a source is a text, usually named .s",
        ) from None


def _parse_allow(comment: Token) -> Allow | None:
    """Return the codes that a comment allows; None if it is prose.

    Raises:
        SourceError: NP030 the comment is malformed.
    """
    text = comment.text
    start = len(comment.line.text.rstrip()) - len(text)

    def wrong(message: str, at: int, length: int, hint: str | None = None) -> SourceError:
        span = Span(comment.line, start + at, length)
        return SourceError("NP030", message, span, suggestion=hint)

    found = _COMMENT.match(text)
    if found is None or (found["word"] != "allow" and "NPW" not in text):
        return None
    word = found["word"]
    if word != "allow":
        message = f"expected 'npchip: allow CODE REASON', found {quoted(word)}"
        raise wrong(message, found.start("word"), max(1, len(word)), did_you_mean(word, ["allow"]))
    codes: list[str] = []
    position = found.start("rest")
    while match := _CODE.match(text, position):
        code = match["code"]
        if code not in WARNINGS:
            whole = f"NPW{code[3:]:0>2}"  # of NPW4
            near = f"did you mean {whole}?" if whole in WARNINGS else did_you_mean(code, WARNINGS)
            hint = near if code.startswith("NPW") else "an error cannot be allowed"
            raise wrong(f"{quoted(code)} is not the code of a warning", position, len(code), hint)
        codes.append(code)
        position = match.end()
    if not codes:
        raise wrong("expected the code of a warning after 'npchip: allow'", 0, len(text))
    if not any(char.isalnum() for char in text[position:]):
        hint = f"say why, such as '; npchip: allow {codes[0]} called by the second version'"
        raise wrong(f"{' '.join(codes)} is allowed without a reason", 0, len(text), hint)
    return Allow(comment.line, Span(comment.line, start, len(text)), tuple(codes))
