"""Draws mutants: small mistakes in the sources and in the instruction-set file."""

from __future__ import annotations

import ast
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

_OPERATORS: Final[dict[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.FloorDiv,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitAnd,
}
_COMPARISONS: Final[dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
_REMOVED: Final = (ast.AugAssign, ast.Raise, ast.Delete, ast.Continue, ast.Break)
_UNDRAWN: Final = (ast.JoinedStr, ast.Import, ast.ImportFrom)  # Python 3.11 misplaces f-strings
_YAML: Final = (  # what a pattern finds, and what may stand there instead
    (r"(?<=[\" 01dsimbkptcnl])[01](?=[01 dsimbkptcnl]*\")", lambda bit: str(1 - int(bit))),
    (r"(?<=: )\d+(?=[,}])", lambda number: str(int(number) + 1)),
    (r" (\+|-|&|\|) (?=\w)", lambda sign: f" {'-+|&'['+-&|'.index(sign.strip())]} "),
    (r"<<|>>|==", {"<<": ">>", ">>": "<<", "==": "!="}.__getitem__),
    (r"\b(and|or)\b(?=[^\"]*$| \w+ ==)", {"and": "or", "or": "and"}.__getitem__),
    (r"\bnot (?=[CZ])", lambda _: ""),
    (r"\b(carry|borrow|any|none)(?=\()", dict(zip(
        ("carry", "borrow", "any", "none"), ("borrow", "carry", "none", "any"), strict=True
    )).__getitem__),
    (r"(?<=timing: )\w+", lambda name: "alu" if name != "alu" else "move"),
)  # fmt: skip


class Mutant(NamedTuple):
    """A mistake in one file.

    Attributes:
        path: the file, relative to the package.
        line: 1-based line.
        function: qualified name of the function around it; empty outside functions.
        start, end: place in the file's bytes.
        was, becomes: the text there, and the one instead.
    """

    path: str
    line: int
    function: str
    start: int
    end: int
    was: str
    becomes: str

    def __str__(self) -> str:
        was, becomes = (" ".join(text.split()) for text in (self.was, self.becomes))
        return f"{self.path}:{self.line}: {was[:60]} -> {becomes[:60]}"

    def applied(self, content: bytes) -> bytes:
        """Return the content of the file with the mistake."""
        return content[: self.start] + self.becomes.encode() + content[self.end :]


def draw(package: Path, rooms: tuple[str, ...], count: int, seed: int) -> list[Mutant]:
    """Draw mutants from rooms, each place with the same chance.

    Args:
        package: folder of the package.
        rooms: its packages that are drawn from.
        count: how many.
        seed: the same seed draws the same from the same sources.
    """
    paths = [p for room in rooms for p in sorted((package / room).rglob("*")) if p.is_file()]
    places: list[list[Mutant]] = []
    for path in paths:
        name = path.relative_to(package).as_posix()
        if path.suffix == ".py":
            places += _Sites(name, path.read_bytes()).places()
        elif path.suffix == ".yaml":
            places += _yaml_places(name, path.read_text("utf-8"))
    chance = random.Random(seed)
    chance.shuffle(places)
    return [chance.choice(place) for place in places[:count]]


def _yaml_places(path: str, text: str) -> Iterator[list[Mutant]]:
    at = 0
    for number, line in enumerate(text.splitlines(keepends=True), 1):
        code = re.sub(r"text: .*|title: .*|#(?!\{).*|^      [A-Z].*|^name:.*", "", line)
        code = re.sub(r"^ *- ", lambda item: " " * len(item.group()), code)
        for pattern, instead in _YAML:
            for found in re.finditer(pattern, code):
                start = at + len(line[: found.start()].encode())
                was = found.group()
                end = start + len(was.encode())
                yield [Mutant(path, number, "", start, end, was, instead(was))]
        at += len(line.encode())


class _Sites(ast.NodeVisitor):
    """The places of a source, each with the mistakes that can be made there."""

    def __init__(self, path: str, source: bytes) -> None:
        self._path = path
        self._source = source
        self._starts = [0]
        for line in source.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self._around: list[str] = []
        self._function = ""
        self._places: list[list[Mutant]] = []

    def places(self) -> list[list[Mutant]]:
        self.visit(ast.parse(self._source))
        return self._places

    def visit(self, node: ast.AST) -> None:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            self._definition(node)
            return
        if isinstance(node, _UNDRAWN) or _is_for_types(node):
            return
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            return  # a docstring
        instead = list(_alternatives(node))
        if instead and isinstance(node, ast.expr | ast.stmt):
            self._place(node, instead)
        if isinstance(node, ast.If | ast.While | ast.IfExp):
            endless = isinstance(node, ast.While)
            values = [False] if endless else [False, True]
            self._place(node.test, [ast.Constant(value) for value in values])
        if isinstance(node, ast.AnnAssign | ast.arg):
            node.annotation = None
        self.generic_visit(node)

    def _definition(self, node: ast.FunctionDef | ast.ClassDef) -> None:
        before, around = self._function, self._around
        self._around = [*around, node.name]
        if isinstance(node, ast.FunctionDef):
            self._function = ".".join(self._around)
            self._around = [*self._around, "<locals>"]
            self.visit(node.args)
        for statement in node.body:
            self.visit(statement)
        self._function, self._around = before, around

    def _place(self, node: ast.expr | ast.stmt, instead: list[ast.AST | None]) -> None:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start = self._starts[node.lineno - 1] + node.col_offset
        end = self._starts[node.end_lineno - 1] + node.end_col_offset
        was = self._source[start:end].decode()
        texts = ["pass" if other is None else ast.unparse(other) for other in instead]
        if isinstance(node, ast.expr):
            texts = [f"({text})" for text in texts]
        self._places.append(
            [Mutant(self._path, node.lineno, self._function, start, end, was, t) for t in texts]
        )


def _is_for_types(node: ast.AST) -> bool:
    match node:
        case ast.If(test=ast.Name(id="TYPE_CHECKING")) | ast.Call(func=ast.Name(id="cast")):
            return True
        case ast.Subscript(value=ast.Name(id=name)):
            return name[0].isupper() and not name.isupper()  # Literal["yes"]
    return False


def _alternatives(node: ast.AST) -> Iterator[ast.AST | None]:
    """Yield what may stand instead of a node; None for nothing."""
    match node:
        case ast.BinOp(left, op, right) if type(op) in _OPERATORS:
            yield ast.BinOp(left, _OPERATORS[type(op)](), right)
        case ast.Compare(left, [op], [right]):
            yield from (ast.Compare(left, [o()], [right]) for o in _COMPARISONS[type(op)])
        case ast.BoolOp(op, values):
            yield ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
            yield from values
        case ast.UnaryOp(_, operand):
            yield operand
        case ast.Constant(value=bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(value=int() as value):
            yield from (ast.Constant(value + 1), ast.Constant(value - 1))
        case ast.Constant(value=str() as value) if value.isidentifier():
            yield ast.Constant(value + "x")
        case ast.IfExp(_, body, orelse):
            yield from (body, orelse)
        case ast.Return(value) if value is not None and not isinstance(value, ast.Constant):
            yield ast.Return(None)
        case ast.AugAssign(target, op, value) if type(op) in _OPERATORS:
            yield from (None, ast.AugAssign(target, _OPERATORS[type(op)](), value))
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]) | ast.Expr(ast.Call()):
            yield None
        case _ if isinstance(node, _REMOVED):
            yield None
