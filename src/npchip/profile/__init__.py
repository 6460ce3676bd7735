"""Cycles of a program by line, label, routine and frame, and the coverage of a run."""

from npchip.profile.model import Branch, Call, FrameCycles, Label, Profile, Word, profile_of

__all__ = ["Branch", "Call", "FrameCycles", "Label", "Profile", "Word", "profile_of"]
