"""Text to `Program`, and back."""

from npchip.assembler.assembler import assemble, assemble_text
from npchip.assembler.diagnostics import AssemblyError, Diagnostic
from npchip.assembler.disassembler import disassemble, disassemble_word

__all__ = [
    "AssemblyError",
    "Diagnostic",
    "assemble",
    "assemble_text",
    "disassemble",
    "disassemble_word",
]
