"""Instructions and their effect on chosen NPs: as text, JSON Lines or a value change dump."""

from npchip.trace.record import Change, Event, Seen, record
from npchip.trace.seek import Position, seek

__all__ = ["Change", "Event", "Position", "Seen", "record", "seek"]
