"""Names of registers that nothing declares."""

from __future__ import annotations

import pytest

from npchip.assembler import AssemblyError, assemble_text
from npchip.isa import Form, load_isa


@pytest.mark.parametrize("name", load_isa().forms)
def test_an_undeclared_register_is_named_wherever_a_register_is_wanted(name: str) -> None:
    """Each instruction that takes a register says how to declare one, in each of its places."""
    for form in load_isa().forms[name]:
        slots = {slot.name: slot.operand for slot in form.slots.values()}
        for wrong in (key for key, operand in slots.items() if operand.kind == "register"):
            line = written(form, "far", wrong)
            with pytest.raises(AssemblyError) as caught:
                assemble_text(f".reg near, r0\n{line}\n{line}\n")
            (error,) = caught.value.diagnostics
            assert (error.code, error.message) == ("NP007", "unknown name 'far'"), line
            assert ".reg far, r" in (error.suggestion or ""), line
            assert error.notes[0].message == "also in line 3", line


def written(form: Form, name: str, wrong: str) -> str:
    """Return a line in a form, with a name in place of one of its registers."""
    least = {"condition": "LO", "label": "0", "number": "64", "register": "near"}
    parts = [
        part
        if isinstance(part, str)
        else name
        if part.name == wrong
        else next(iter(part.operand.choices), "")
        or (str(part.operand.least) if part.operand.kind == "number" else least[part.operand.kind])
        for part in form.tokens
    ]
    return f"        {form.mnemonic} {' '.join(parts)}"


def test_names_are_given_different_registers_and_those_in_use_stay() -> None:
    with pytest.raises(AssemblyError) as caught:
        assemble_text(".reg a, r0\n ADD b, r1\n ADD a, c\n ROW b\n")
    hints = [each.suggestion for each in caught.value.diagnostics]
    assert hints == [
        "no register is called b: .reg b, r2 names one",
        "no register is called c: .reg c, r3 names one",
    ]


def test_without_a_free_register_none_is_named() -> None:
    names = "".join(f".reg name{n}, r{n}\n" for n in range(16))
    with pytest.raises(AssemblyError) as caught:
        assemble_text(f"{names} ROW far\n")
    assert ".reg far, REGISTER names one" in str(caught.value)
