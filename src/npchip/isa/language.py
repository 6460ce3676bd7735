"""The language of semantics in the instruction-set file, translated to the intermediate form.

The syntax is a small part of Python's. The standard library's parser reads it; nothing is
executed. ``docs/isa-file.md`` describes the language for users.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import reduce
from typing import Final, Literal, cast

from npchip.base.suggest import near_miss
from npchip.isa import ir
from npchip.isa.ir import Type

_ARITHMETIC: Final[dict[type[ast.operator], Literal["+", "-", "&", "|", "^"]]] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.BitXor: "^",
}
_SHIFTS: Final[dict[type[ast.operator], str]] = {ast.LShift: "<<", ast.RShift: ">>"}
_COMPARISONS: Final[dict[type[ast.cmpop], str]] = {
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
}
_EFFECTS: Final[dict[str, tuple[Type, ...]]] = {
    "jump": (Type.CONST,),
    "call": (Type.CONST,),
    "ret": (),
    "halt": (),
    "expose": (),
    "sample": (Type.NAME, Type.CONST),
    "output": (Type.CONST, Type.BYTE),
    "mask_push": (Type.BIT,),
    "mask_invert": (),
    "mask_pop": (),
}

_FLOW: Final = ("jump", "call", "ret", "halt", "expose")
_MASKS: Final = ("mask_push", "mask_invert", "mask_pop")
_NONE: Final = "none"  # the complement of any()
_FLAGS: Final[dict[str, Literal["Z", "C"]]] = {"Z": "Z", "C": "C"}
_POSITIONS: Final = ("row", "column")
_RESERVED: Final = (*_FLAGS, *_POSITIONS, "mem", *ir.FUNCTIONS, _NONE, *_EFFECTS)

Scope = Mapping[str, ir.Expr]
"""Expressions of the names in a semantics: operands, and the form's definitions (``let``)."""


class SemanticsError(Exception):
    """A mistake in a semantics text; `line` counts from 1 within it."""

    def __init__(self, message: str, line: int) -> None:
        super().__init__(message)
        self.line = line


def parse_statements(text: str, scope: Scope) -> tuple[ir.Statement, ...]:
    """Translate the semantics of an instruction.

    Args:
        text: statements in the language of ``docs/isa-file.md``.
        scope: expressions of the names.

    Raises:
        SemanticsError: wrong syntax, an unknown name, or types that do not fit.
    """
    with _readable():
        return tuple(_Translator(scope).block(ast.parse(text).body))


def parse_expression(text: str, scope: Scope) -> ir.Expr:
    """Translate one expression; raise as `parse_statements` does."""
    with _readable():
        return _Translator(scope).expr(ast.parse(text, mode="eval").body)


@contextmanager
def _readable() -> Iterator[None]:
    try:
        yield
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        line = error.lineno if isinstance(error, SyntaxError) else None
        message = error.msg if isinstance(error, SyntaxError) else error
        raise SemanticsError(f"cannot be read: {message}", line or 1) from None


def _near(name: str, known: Iterable[str]) -> str:
    match = near_miss(name, known)
    return f"; did you mean '{match}'?" if match else ""


def _fail(node: ast.AST, message: str) -> SemanticsError:
    return SemanticsError(message, getattr(node, "lineno", 1))


class _Translator:
    def __init__(self, scope: Scope) -> None:
        self._scope = dict(scope)
        self._locals: dict[str, ir.Local] = {}

    # ---- statements

    def block(self, body: list[ast.stmt], guard: ir.Expr | None = None) -> Iterator[ir.Statement]:
        left = False
        for node in body:
            if left:
                raise _fail(node, "nothing may follow a statement that changes the flow")
            for statement in self._statement(node, guard):
                yield statement
                left = isinstance(statement, ir.Effect) and statement.name in _FLOW

    def _statement(self, node: ast.stmt, guard: ir.Expr | None) -> Iterator[ir.Statement]:
        match node:
            case ast.Expr(value=ast.Call() as call):
                yield self._effect(call, guard)
            case _ if guard is not None:
                raise _fail(node, "an if may hold effects only, such as jump(target)")
            case ast.Pass():
                return
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                yield self._assign(node, name, value)
            case ast.Assign(
                targets=[ast.Subscript(value=ast.Name(id="mem"), slice=address)], value=value
            ):
                yield ir.Store(self._byte(address), self._byte(value))
            case ast.If(test=test, body=body, orelse=[]):
                yield from self.block(body, self._typed(test, Type.WIRE))
            case _:
                raise _fail(
                    node, "expected an assignment, an effect such as jump(target), or an if"
                )

    def _assign(self, node: ast.stmt, name: str, value: ast.expr) -> ir.Statement:
        if name in _FLAGS:
            return ir.SetFlag(_FLAGS[name], self._typed(value, Type.BIT))
        if name in self._scope:
            target = self._scope[name]
            if not isinstance(target, ir.Register):
                raise _fail(node, f"'{name}' is not a register in every form")
            return ir.SetRegister(target.name, self._byte(value))
        if name in _RESERVED:
            raise _fail(node, f"'{name}' cannot be assigned")
        expr = self.expr(value)
        if expr.type is not Type.BIT:
            expr = self._fit(value, expr, Type.BYTE)
        self._locals[name] = ir.Local(name, expr.type)
        return ir.SetLocal(name, expr)

    def _effect(self, call: ast.Call, guard: ir.Expr | None) -> ir.Effect:
        name = call.func.id if isinstance(call.func, ast.Name) else ast.unparse(call.func)
        if name not in _EFFECTS:
            raise _fail(call, f"unknown effect '{name}'{_near(name, _EFFECTS)}")
        if guard is not None and name in _MASKS:
            raise _fail(call, f"{name}() may not depend on an if: an address has one mask depth")
        kinds = _EFFECTS[name]
        self._count(call, name, len(kinds), len(kinds))
        args = tuple(self._typed(arg, kind) for arg, kind in zip(call.args, kinds, strict=True))
        return ir.Effect(cast("ir.EffectName", name), args, guard)

    # ---- expressions

    def expr(self, node: ast.expr) -> ir.Expr:
        match node:
            case ast.Constant(value=int() as value) if not isinstance(value, bool):
                return ir.Const(value)
            case ast.Name(id=name):
                return self._name(node, name)
            case ast.BinOp(left=left, op=op, right=right):
                return self._arithmetic(node, left, op, right)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                inner = self.expr(operand)
                if inner.type is Type.WIRE:
                    return ir.Operation("not_wire", (inner,))
                return ir.Operation("not", (self._fit(operand, inner, Type.BIT),))
            case ast.UnaryOp(op=ast.Invert(), operand=operand):
                return self._operation("~", operand)
            case ast.BoolOp(op=op, values=values):
                word = "and" if isinstance(op, ast.And) else "or"
                bits = [self._typed(value, Type.BIT) for value in values]
                return reduce(lambda a, b: ir.Operation(word, (a, b)), bits)
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _COMPARISONS:
                return self._operation(_COMPARISONS[type(op)], left, right)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                condition = self._typed(test, Type.BIT)
                then = self.expr(body)
                kind = Type.BIT if then.type is Type.BIT else Type.BYTE
                then, otherwise = self._fit(body, then, kind), self._typed(orelse, kind)
                select = "select_bit" if kind is Type.BIT else "select"
                return ir.Operation(select, (condition, then, otherwise))
            case ast.Subscript(value=ast.Name(id="mem"), slice=address):
                return self._operation("load", address)
            case ast.Subscript(value=value, slice=index):
                number = self._typed(index, Type.CONST)
                if isinstance(number, ir.Const) and not 0 <= number.value <= 7:
                    raise _fail(index, f"a byte has the bits 0 to 7, found {number.value}")
                return ir.Operation("bit", (self._byte(value), number))
            case ast.Call(func=ast.Name(id=name)):
                return self._call(node, name)
        raise _fail(node, f"'{ast.unparse(node)}' is not part of the language")

    def _name(self, node: ast.expr, name: str) -> ir.Expr:
        if name in self._locals:
            return self._locals[name]
        if name in self._scope:
            return self._scope[name]
        if name in _FLAGS:
            return ir.Flag(_FLAGS[name])
        if name in _POSITIONS:
            return ir.Operation(name, ())
        known = [*self._scope, *self._locals, *_RESERVED]
        raise _fail(node, f"unknown name '{name}'{_near(name, known)}")

    def _arithmetic(
        self, node: ast.expr, left: ast.expr, op: ast.operator, right: ast.expr
    ) -> ir.Expr:
        if type(op) in _SHIFTS:
            count = self._typed(right, Type.CONST)
            return ir.Operation(_SHIFTS[type(op)], (self._byte(left), count))
        if type(op) not in _ARITHMETIC:
            raise _fail(node, "the ALU has only + - & | ^ << >> and comparisons")
        word = _ARITHMETIC[type(op)]
        a, b = self.expr(left), self.expr(right)
        if a.type is Type.CONST and b.type is Type.CONST:
            return ir.Arithmetic(word, a, b)
        return ir.Operation(word, (self._fit(left, a, Type.BYTE), self._fit(right, b, Type.BYTE)))

    def _call(self, node: ast.Call, name: str) -> ir.Expr:
        function = "any" if name == _NONE else name
        if function not in ir.FUNCTIONS:
            known = (*ir.FUNCTIONS, _NONE)
            raise _fail(node, f"unknown function '{name}'{_near(name, known)}")
        signature = ir.FUNCTIONS[function]
        most = len(signature.args)
        self._count(node, name, most - signature.optional, most)
        found = self._operation(function, *node.args)
        return ir.Operation("not_wire", (found,)) if name == _NONE else found

    def _operation(self, op: str, *args: ast.expr) -> ir.Operation:
        """Translate an operation with arguments of the types of its signature."""
        kinds = ir.OPERATIONS[op].args
        return ir.Operation(
            op, tuple(self._typed(arg, kind) for arg, kind in zip(args, kinds, strict=False))
        )

    # ---- types

    def _byte(self, node: ast.expr) -> ir.Expr:
        return self._typed(node, Type.BYTE)

    def _typed(self, node: ast.expr, expected: Type) -> ir.Expr:
        return self._fit(node, self.expr(node), expected)

    @staticmethod
    def _fit(node: ast.expr, expr: ir.Expr, expected: Type) -> ir.Expr:
        """Return the translation of `node` as an expression of the expected type."""
        if expr.type is expected:
            return expr
        if expected is Type.BYTE and expr.type is Type.CONST:
            if isinstance(expr, ir.Const) and not 0 <= expr.value <= 255:
                raise _fail(node, f"{expr.value} does not fit in a byte (0 to 255)")
            return ir.Immediate(expr)
        raise _fail(
            node, f"expected a {expected.value}, found a {expr.type.value}: '{ast.unparse(node)}'"
        )

    @staticmethod
    def _count(call: ast.Call, name: str, least: int, most: int) -> None:
        if call.keywords or not least <= len(call.args) <= most:
            wanted = str(least) if least == most else f"{least} or {most}"
            raise _fail(call, f"{name}() takes {wanted} arguments, found {len(call.args)}")
