"""The places of the studio: the sources of a clone, the built page, and its files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from npchip.base.errors import InputError

HOME: Final = Path(__file__).parent
PAGE: Final = HOME / "page"
"""Sources of the page: in a clone only."""
SITE: Final = HOME / "site"
"""The built page: in a wheel, and in a clone after a build."""
VERSION_FILE: Final = "version.json"
"""Written last; without it a page is none."""
PLAYER: Final = "player.html"
"""Template of `npchip export`; no address of the page."""
COMPRESSED: Final = ".gz"


def is_clone() -> bool:
    """Return whether the sources of the page are here, so that it can be built."""
    return (PAGE / "shell" / "index.html").is_file()


def need_site() -> Path:
    """Return the folder of the built page.

    Raises:
        InputError: NP630, there is none.
    """
    if (SITE / VERSION_FILE).is_file():
        return SITE
    if is_clone():
        raise InputError(
            "NP630",
            "the page of the studio has not been built yet",
            hint="build and start it: npchip studio --build (pip install --editable '.[studio]'"
            " first, if Node.js 20 or newer is not there)",
        )
    raise InputError(
        "NP630",
        "this npchip was installed without the page of the studio",
        hint="install a release wheel, which has it, or work in a clone:"
        " pip install --editable '.[studio]' && npchip studio --build",
    )


def site_files(site: Path) -> list[Path]:
    """Return the files that belong to the page as people open it, sorted."""
    found = (path for path in site.rglob("*") if path.is_file() and path.suffix != COMPRESSED)
    return sorted(path for path in found if path != site / PLAYER)


def known_version(site: Path) -> dict[str, Any]:
    """Return what ``version.json`` says of a page; nothing if there is none."""
    try:
        known = json.loads((site / VERSION_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return known if isinstance(known, dict) else {}
