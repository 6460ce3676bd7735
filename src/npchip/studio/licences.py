"""Licences of all third-party code that is in the page."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path
from typing import Final, NamedTuple

from npchip.base.errors import InputError
from npchip.studio.assets import PYODIDE
from npchip.studio.places import HOME

_TEXTS: Final = HOME / "licences"
"""Texts of licences of which a package has no copy."""
_PAGE: Final = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Licences · npchip studio</title>
<style>
:root {{ color-scheme: light dark; }}
body {{ font: 1rem/1.5 system-ui, sans-serif; max-width: 50rem; margin: auto; padding: 1rem; }}
pre {{ white-space: pre-wrap; font-size: .85rem; }}
summary {{ cursor: pointer; padding: .25rem 0; }}
</style>
</head>
<body>
<main>
<h1>Licences</h1>
<p>npchip itself is under the MIT licence. Its studio contains code of others, unchanged. The
npm registry has the source of each package under its name and version.</p>
{parts}
<p><a href="./">Back to the studio</a></p>
</main>
</body>
</html>
"""
_PART: Final = """\
<details><summary>{name} {version} – {licence}</summary>
<pre>{text}</pre>
</details>"""


class Part(NamedTuple):
    """A piece of third-party code, and the licence that it comes under."""

    name: str
    version: str
    licence: str
    text: str


def write_licences(site: Path, packages: Iterable[Path]) -> None:
    """Write ``licences.json`` and ``licences.html``.

    Args:
        site: the folder to write to.
        packages: folders of the npm packages whose code is in a script.

    Raises:
        InputError: NP633, a package has no text of its licence.
    """
    parts = sorted([*map(of_package, packages), *_of_python()], key=lambda part: part.name.lower())
    listed = json.dumps([part._asdict() for part in parts], indent=1)
    (site / "licences.json").write_text(listed + "\n", encoding="utf-8")
    shown = "\n".join(
        _PART.format(**{key: html.escape(text) for key, text in part._asdict().items()})
        for part in parts
    )
    (site / "licences.html").write_text(_PAGE.format(parts=shown), encoding="utf-8")


def of_package(package: Path) -> Part:
    """Return the licence of an npm package.

    Raises:
        InputError: NP633, it has no text of its licence.
    """
    about = json.loads((package / "package.json").read_text(encoding="utf-8"))
    for path in sorted(package.iterdir()):
        if re.fullmatch(r"(licen[cs]e|copying)(\.\w+)?", path.name, re.IGNORECASE):
            text = path.read_text(encoding="utf-8")
            return Part(about["name"], about["version"], about["license"], text)
    raise InputError(
        "NP633",
        f"the package {about['name']} {about['version']} has no text of its licence",
        hint="write it to src/npchip/studio/licences, and name it in licences.py",
    )


def _of_python() -> list[Part]:
    version = json.loads((PYODIDE / "package.json").read_text(encoding="utf-8"))["version"]
    python = json.loads((PYODIDE / "pyodide-lock.json").read_text(encoding="utf-8"))["info"]
    yaml = metadata.distribution("PyYAML")
    own = [path for path in yaml.files or () if path.name == "LICENSE"]
    if not own:
        raise InputError(
            "NP633",
            f"PyYAML {yaml.version} is installed without the text of its licence",
            hint="pip install --force-reinstall PyYAML",
        )
    return [
        Part("Pyodide", version, "MPL-2.0", _text("MPL-2.0")),
        Part("Libraries in Pyodide", version, "see there", _text("pyodide-parts")),
        Part("Python", python["python"], "PSF-2.0", _text("PSF-2.0")),
        Part("PyYAML", yaml.version, "MIT", own[0].read_text(encoding="utf-8")),
    ]


def _text(name: str) -> str:
    return (_TEXTS / f"{name}.txt").read_text(encoding="utf-8")
