"""Programs, clips, rigs and scenes that come with npchip, by name."""

from npchip.bundle.files import Bundled, What, all_files, bundled, find, hint, need, top

__all__ = ["Bundled", "What", "all_files", "bundled", "find", "hint", "need", "top"]
