"""Programs, clips, rigs and scenes that come with npchip, by name; the course."""

from npchip.bundle.files import Bundled, What, all_files, bundled, course, find, hint, need, top

__all__ = ["Bundled", "What", "all_files", "bundled", "course", "find", "hint", "need", "top"]
