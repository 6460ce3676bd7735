"""What can be said of a program's cycles without running it."""

from npchip.static.spans import Loop, Span
from npchip.static.view import Routine, StaticView, static_view
from npchip.static.ways import TooManyWaysError

__all__ = ["Loop", "Routine", "Span", "StaticView", "TooManyWaysError", "static_view"]
