"""The reference engine: one instruction at a time, all NPs at once."""

from npchip.engines.reference.engine import ReferenceEngine

__all__ = ["ReferenceEngine"]
