"""The template of the pages that ``npchip export`` writes: one file that needs nothing else."""

from __future__ import annotations

import base64
import hashlib
import tempfile
from pathlib import Path
from typing import Final

from npchip.studio.bundling import Bundler, with_policy
from npchip.studio.places import PAGE, PLAYER

SOURCE: Final = PAGE / "player"


def write_player(bundler: Bundler, site: Path) -> None:
    """Write ``player.html``: scripts and styles stand in it, and are all that it may run."""
