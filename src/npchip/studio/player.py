"""The template of the pages that ``npchip export`` writes: one file that needs nothing else."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from npchip.base.errors import InputError
from npchip.studio.bundling import Bundler, with_policy
from npchip.studio.licences import of_package
from npchip.studio.places import PLAYER

POLICY: Final = (
    "default-src 'none'; "
    "script-src 'sha256-{digest}' 'wasm-unsafe-eval'; "
    "worker-src blob:; "
    "style-src 'unsafe-inline'; "
    "img-src blob: data:; "
    "media-src blob:; "
    "base-uri 'none'; "
    "form-action 'none'"
)
"""The policy of an exported page: run the script in it, and start its worker."""
_PAGE: Final = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="npchip">
<title>@title@</title>
<style>
{style}</style>
</head>
<body>
<div id="player"></div>
<noscript>The program runs in your browser and needs JavaScript: please allow it.</noscript>
<details class="player-about">
<summary>Made with npchip; licences</summary>
<pre>{licences}</pre>
</details>
<script type="application/json" id="machine">{machine}</script>
<script type="application/json" id="data">@data@</script>
<script>{script}</script>
</body>
</html>
"""


def write_player(bundler: Bundler, site: Path) -> set[Path]:
    """Write ``player.html``: scripts and styles stand in it, and are all that it may run.

    Returns:
        folders of the packages whose code is in it.
    """
    bundler = bundler.another()
    with tempfile.TemporaryDirectory() as folder:
        player, worker = Path(folder) / "player.js", Path(folder) / "machine.js"
        bundler.script(player, "page/player/main.tsx", "page/player/player.css")
        bundler.script(worker, "page/machine/worker.ts")
        script = player.read_text(encoding="utf-8").strip()
        style = player.with_suffix(".css").read_text(encoding="utf-8")
        machine = in_script(worker.read_text(encoding="utf-8"))
    if "</script" in script or "@data@" in script or "@title@" in script:
        raise InputError("NP633", "the player's script holds what would end or change its page")
    page = _PAGE.format(
        style=style,
        licences=html.escape(_licences(bundler.packages)),
        machine=machine,
        script=script,
    )
    allowed = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    page = with_policy(page, POLICY.format(digest=allowed))
    (site / PLAYER).write_text(page, encoding="utf-8", newline="\n")
    return bundler.packages


def fill(template: str, title: str, data: Any) -> str:
    """Return the page of a program.

    Args:
        template: what `write_player` wrote.
        title: its title.
        data: what page/player/data.ts reads.
    """
    head, _, rest = template.partition("@title@")
    middle, _, tail = rest.partition("@data@")
    return "".join((head, html.escape(title), middle, in_script(data), tail))


def in_script(data: Any) -> str:
    """Return data as JSON that cannot end the element that holds it."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")


def _licences(packages: Iterable[Path]) -> str:
    parts = sorted(map(of_package, packages))
    return "\n\n".join(f"{part.name} {part.version}\n\n{part.text.strip()}" for part in parts)
