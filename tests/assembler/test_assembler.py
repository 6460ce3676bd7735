"""The assembler: what a source means."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from npchip.assembler import AssemblyError, assemble, assemble_text, disassemble_word
from npchip.base.errors import InputError
from npchip.isa import load_isa
from npchip.program.model import Budget, Output, Program

ROOT = Path(__file__).parents[2]


def value(expression: str, before: str = "") -> int:
    """Return the value of an expression; any integer, since a constant has no width."""
    return assemble_text(f"{before}\n.equ RESULT, {expression}\nHALT").symbols["RESULT"]


def words(text: str) -> tuple[int, ...]:
    return assemble_text(text).words


def codes(text: str) -> list[str]:
    with pytest.raises(AssemblyError) as caught:
        assemble_text(text)
    return [item.code for item in caught.value.diagnostics]


# ---- expressions


def test_numbers() -> None:
    assert value("0x1F + 0X1f + 0b0001_1111 + 31 + 1_0") == 4 * 31 + 10
    assert value("'A' + '\\n' + '\\0' + '\\t' + '\\\\' + '\\'' + ';' + '\"'") == (
        sum(map(ord, "A\n\0\t\\';\""))
    )


_SIGNS = ("*", "/", "%", "+", "-", "<<", ">>", "&", "^", "|")
_COMPARISONS = ("==", "!=", "<", "<=", ">", ">=")


def expressions() -> st.SearchStrategy[str]:
    def extend(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        return st.one_of(
            st.tuples(st.sampled_from("-+~"), inner).map(" ".join),
            inner.map("({})".format),
            st.tuples(inner, st.sampled_from(_SIGNS), inner).map(" ".join),
            # Python chains comparisons, the assembler does not: they stand in parentheses.
            st.tuples(inner, st.sampled_from(_COMPARISONS), inner).map(
                lambda parts: f"(({parts[0]}) {parts[1]} ({parts[2]}))"
            ),
        )

    return st.recursive(st.integers(0, 300).map(str), extend, max_leaves=12)


def in_python(expression: str) -> int | None:
    """Return Python's value; `/` is its floor division. None if there is no result."""
    try:
        return int(eval(expression.replace("/", "//")))  # noqa: S307 - made above
    except (ZeroDivisionError, ValueError):
        return None


@given(expressions())
def test_expressions_are_those_of_python(expression: str) -> None:
    try:
        found: int | None = value(expression)
    except AssemblyError as error:
        # No result, or one that is too large on the way to it.
        event("no result")
        found = None if error.code == "NP010" else 0
    assert found is None or found == in_python(expression)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1 + 2 * 3", 7),
        ("10 - 4 - 3", 3),
        ("1 << 2 + 1", 8),
        ("7 & 3 << 1", 6),
        ("1 | 6 & 4 ^ 1", 5),
        ("5 & 4 == 4", 1),
        ("-2 * 3", -6),
        ("2 * -3", -6),
        ("~0 & 0xFF", 255),
        ("-7 / 2", -4),
        ("-7 % 3", 2),
        ("-(1 + 2)", -3),
        ("1 < 2", 1),
        ("3 <= 2", 0),
    ],
)
def test_precedence(expression: str, expected: int) -> None:
    assert value(expression) == expected


def test_a_deep_expression_does_not_nest_python_calls() -> None:
    depth = 20_000
    assert value("(" * depth + "1" + ")" * depth) == 1
    assert value("-" * depth + "1") == 1
    assert value("+".join(["1"] * depth)) == depth


def test_bounds_of_a_result() -> None:
    assert value("(1 << 61) - 1 + (1 << 61)") == (1 << 62) - 1
    assert codes(".equ A, 1 << 62\nHALT") == ["NP010"]
    assert codes(".equ A, -(1 << 61) - (1 << 61)\nHALT") == ["NP010"]


def test_a_byte_may_be_written_signed() -> None:
    assert words("MOV r0, #-1") == words("MOV r0, #255")
    assert words("MOV r0, #-128") == words("MOV r0, #0x80")
    assert words("MOV r0, #~0x0F") == words("MOV r0, #0xF0")
    assert codes("MOV r0, #-129") == codes("MOV r0, #256") == ["NP006"]


# ---- names


def test_constants_may_come_later() -> None:
    assert value("A + 1", ".equ A, B * 2\n.equ B, end - start\nstart: NOP\nNOP\nend: NOP") == 5


def test_a_long_chain_of_later_constants() -> None:
    def chain(length: int) -> str:
        return "".join(f".equ C{i}, C{i + 1} + 1\n" for i in range(length)) + f".equ C{length}, 0\n"

    assert value("C0", chain(60)) == 60
    assert "NP015" in codes(chain(2000) + "MOV r0, #C0")
    forward = ".equ C0, 0\n" + "".join(f".equ C{i + 1}, C{i} + 1\n" for i in range(2000))
    assert value("C2000", forward) == 2000


def test_predefined_geometry(tmp_path: Path) -> None:
    text = "MOV r0, #NP_ROWS\nMOV r1, #NP_COLS\nMOV r2, #ROWS\nMOV r3, #COLS\nHALT"
    low = [word & 0xFF for word in assemble_text(text).words[:4]]
    assert low == [8, 10, 64, 80]
    machine = tmp_path / "big.yaml"
    machine.write_text("extends: default\ngeometry: {np_rows: 16, np_cols: 20}\n")
    program = assemble_text(text, machine=machine)
    assert [word & 0xFF for word in program.words[:4]] == [16, 20, 128, 160]
    assert program.geometry == (16, 20)


def test_defines_take_the_place_of_constants() -> None:
    text = ".equ A, 5\n.equ B, A + 1\nMOV r0, #B\n.if A > 10\nNOP\n.endif\nHALT"
    program = assemble_text(text, defines={"A": 20})
    assert program.symbols == {"A": 20, "B": 21}
    assert len(program.words) == 3
    assert len(words(text)) == 2


def test_define_of_an_unknown_name() -> None:
    with pytest.raises(InputError, match=r"no \.equ constant 'LIMT'") as caught:
        assemble_text(".equ LIMIT, 5\nMOV r0, #LIMIT\nHALT", defines={"LIMT": 1})
    assert caught.value.code == "NP026"
    assert caught.value.hint == "did you mean LIMIT?"
    with pytest.raises(InputError, match="'ROWS'"):
        assemble_text("HALT", defines={"ROWS": 1})


def test_register_names_may_come_after_their_use() -> None:
    assert words("MOV value, #1\nHALT\n.reg value, r7") == words("MOV R7, #1\nHALT")


def test_case_matters_in_names_only() -> None:
    assert words("mov R1, #1\nWhere lo\nend\nNbr r1, R2, North\nhalt") == (
        words("MOV r1, #1\nWHERE LO\nEND\nNBR r1, r2, north\nHALT")
    )
    assert assemble_text("Loop: JMP loop\nloop: JMP Loop").labels == {"Loop": 0, "loop": 1}


# ---- labels


def test_labels() -> None:
    program = assemble_text("a: b: NOP\nc:\n\n  d: HALT\ne:\nJMP e\n")
    assert program.labels == {"a": 0, "b": 0, "c": 1, "d": 1, "e": 2}
    assert disassemble_word(program.words[2], load_isa(), {2: "e"}) == "JMP e"


def test_local_labels_belong_to_the_label_above() -> None:
    program = assemble_text(
        "JMP .x\n.x: NOP\na: JMP .x\n.x: NOP\nb: JMP .x\n.x: JMP .y\n.y: JMP .x\n"
    )
    targets = [word & 0x1FF for word in program.words]
    assert [targets[at] for at in (0, 2, 4, 5, 6)] == [1, 3, 5, 6, 5]
    assert program.labels == {"a": 2, "b": 4}


def test_a_local_label_of_its_own_line() -> None:
    assert words("a: .x: JMP .x") == words("JMP 0")


# ---- outputs, budgets, words


def test_outputs_and_budgets() -> None:
    program = assemble_text(
        ".equ P, 3\n.output a, 0, scalar\n.output b, P + 1, picture\n"
        ".budget words 2 * 5\n.budget cycles 1000\nOUT 0, r0\nHALT"
    )
    assert program.outputs == (Output("a", 0, "scalar"), Output("b", 4, "picture"))
    assert program.budget == Budget(words=10, cycles=1000)
    assert assemble_text("HALT").budget == Budget()


def test_raw_words() -> None:
    assert words(".word 0x1234\n.equ A, 2\n.word A << 4\nHALT")[:2] == (0x1234, 0x20)
    assert codes(".word 0x10000\nHALT") == ["NP006"]
    assert codes(".word\nHALT") == ["NP009"]


def test_a_jump_into_raw_words_keeps_its_masks() -> None:
    where = words("WHERE EQ\nEND")[0]
    assert len(words(f".word {where}\nEND\nHALT\n.word 7\nEND")) == 5
    assert codes(f"a: .word {where}\nJMP a") == ["NP020"]


@pytest.mark.parametrize("count", [511, 512])
def test_as_many_words_as_the_rom_has(count: int) -> None:
    assert len(words("NOP\n" * (count - 1) + "HALT")) == count


@pytest.mark.parametrize("count", [513, 600, 2000])
def test_a_word_too_many(count: int) -> None:
    with pytest.raises(AssemblyError) as caught:
        assemble_text("NOP\n" * count)
    (only,) = caught.value.diagnostics
    assert only.code == "NP018"
    assert only.message == f"the program has {count} words: {count - 512} more than the ROM's 512"
    assert only.span.line.number == 513


def test_budget_of_words() -> None:
    assert len(words(".budget words 2\nNOP\nHALT")) == 2
    assert codes(".budget words 1\nNOP\nHALT") == ["NP019"]


# ---- the program


def test_every_word_knows_its_line() -> None:
    text = ".macro two a\n  ADD a, #1\n  .rept 2\n    SUB a, #1\n  .endr\n.endm\n  two r1\n  HALT"
    program = assemble_text(text, "x.s")
    assert [(item.file, item.line) for item in program.source] == [
        ("x.s", 2),
        ("x.s", 4),
        ("x.s", 4),
        ("x.s", 8),
    ]
    assert program.source[1].text == "    SUB a, #1"
    assert [item.written_at.line for item in program.source] == [7, 7, 7, 8]
    outer = program.source[1].expanded_from
    assert outer is not None
    assert outer.line == 3
    assert outer.expanded_from is not None
    assert outer.expanded_from.line == 7
    assert program.place(3) == program.source[3]
    assert program.place(4) is None


def test_name_and_line_ends(tmp_path: Path) -> None:
    file = tmp_path / "blink.s"
    file.write_bytes(b"\xef\xbb\xbfNOP ; one\r\n\r\n\tHALT\r\n")
    program = assemble(file)
    assert program.name == "blink"
    assert [item.text for item in program.source] == ["NOP ; one", "\tHALT"]
    assert [item.line for item in program.source] == [1, 3]


@pytest.mark.parametrize("path", sorted((ROOT / "asm").glob("*.s")), ids=lambda path: path.stem)
def test_the_programs_that_ship_give_no_warning(path: Path) -> None:
    warnings: list[str] = []
    assemble(path, on_warning=lambda item: warnings.append(str(item)))
    assert not warnings


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    for path in (tmp_path / "none.s", tmp_path, "\0"):
        with pytest.raises(InputError) as caught:
            assemble(path)
        assert caught.value.code == "NP025"
    large = tmp_path / "large.s"
    large.write_bytes(b";" * (1 << 18) + b"\n")
    with pytest.raises(InputError, match="256 KiB"):
        assemble(large)
    with pytest.raises(InputError, match="256 KiB"):
        assemble_text(large.read_text())


def test_a_folder_names_the_program_in_it(tmp_path: Path) -> None:
    folder = tmp_path / "alarm"
    folder.mkdir()
    hints = []
    for name in ("nothing.txt", "checks.s", "other.s", "alarm.s"):
        (folder / name).write_text("HALT\n")
        with pytest.raises(InputError) as caught:
            assemble(folder)
        assert caught.value.code == "NP025"
        hints.append(caught.value.hint)
    only, own = (f"did you mean {folder / name}?" for name in ("checks.s", "alarm.s"))
    assert hints == [None, only, None, own]


@pytest.mark.long
def test_a_disassembled_word_gives_the_word_again() -> None:
    """All defined words, in portions that fit the ROM; each portion behind a HALT.

    What cannot be reached has no mask depth, and so no fault of masks.
    """
    isa = load_isa()
    texts = {word: disassemble_word(word, isa) for word in range(1 << 16)}
    defined = [word for word, text in texts.items() if text is not None]
    assert len(defined) > 50_000
    for start in range(0, len(defined), 511):
        portion = defined[start : start + 511]
        source = "HALT\n" + "\n".join(str(texts[word]) for word in portion)
        assert list(words(source)[1:]) == portion


def test_only_right_programs_have_warnings() -> None:
    warnings: list[str] = []

    def program(text: str) -> Program:
        return assemble_text(text, on_warning=lambda item: warnings.append(item.code))

    program(".equ A, 1\nMOV r0, #1")
    assert warnings == ["NPW02", "NPW05"]
    with pytest.raises(AssemblyError):
        program(".equ A, 1\nMOV r0, 1")
    assert len(warnings) == 2


def test_too_many_errors() -> None:
    with pytest.raises(AssemblyError) as caught:
        assemble_text("MOV r0, 1\n" * 300)
    assert len(caught.value.diagnostics) == 100
    assert str(caught.value).endswith("100 errors, and the assembler stopped there")
    assert len(codes("MOV r0, 1\n" * 100)) == 100
