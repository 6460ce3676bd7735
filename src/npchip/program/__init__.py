"""Programs and their static analysis."""

from npchip.program.model import OUTPUT_KINDS, Budget, Output, OutputKind, Program, SourceLine

__all__ = ["OUTPUT_KINDS", "Budget", "Output", "OutputKind", "Program", "SourceLine"]
