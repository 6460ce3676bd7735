"""Traces of instructions and their effect on chosen NPs."""

from npchip.trace.record import Change, Event, Seen, record
from npchip.trace.seek import Position, seek

__all__ = ["Change", "Event", "Position", "Seen", "record", "seek"]
