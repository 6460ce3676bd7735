"""The instruction set as data: one YAML file, from which everything else derives."""

from npchip.isa.ir import REGISTERS
from npchip.isa.loader import load_isa, parse_isa, read_isa
from npchip.isa.model import (
    ConditionCode,
    Decoded,
    FieldValue,
    Form,
    Instruction,
    Isa,
    Operand,
    Slot,
)

__all__ = [
    "REGISTERS",
    "ConditionCode",
    "Decoded",
    "FieldValue",
    "Form",
    "Instruction",
    "Isa",
    "Operand",
    "Slot",
    "load_isa",
    "parse_isa",
    "read_isa",
]
