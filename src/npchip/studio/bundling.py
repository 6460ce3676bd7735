"""The page's TypeScript as scripts that a browser loads: esbuild, and the packages that it took."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, Final

from npchip.base.errors import InputError
from npchip.studio.node import Node, run
from npchip.studio.places import HOME, PAGE

POLICY: Final = (
    "default-src 'none'; "
    "script-src 'self' 'wasm-unsafe-eval'; "
    "worker-src 'self'; "
    "connect-src 'self'; "
    "style-src 'self' 'unsafe-inline'; "  # CodeMirror makes its style sheets while it runs
    "img-src 'self' blob: data:; "
    "media-src 'self' blob:; "
    "font-src 'self'; "
    "manifest-src 'self'; "
    "base-uri 'none'; "
    "form-action 'none'"
)
"""The policy of the page: it loads its own files, and what the reader gives it."""
SOURCES: Final = (
    ("studio", "page/shell/main.tsx"),
    ("studio", "page/shell/style.css"),
    ("compiler", "page/compiler/worker.ts"),
    ("machine", "page/machine/worker.ts"),
)
"""Names of the site's scripts and of its style sheet, and the sources in which they begin."""
_TARGETS: Final = ("chrome115", "firefox115", "safari17")
_API: Final = (
    "import { build } from 'esbuild';"
    "try { const made = await build(JSON.parse(process.argv[1]));"
    " process.stdout.write(JSON.stringify(made)); }"
    "catch { process.exitCode = 1; }"  # it has printed the mistakes
)


class Bundler:
    """esbuild, with the same options for all that is bundled.

    Args:
        node: Node.js.
        site: the folder that scripts are written to.

    Attributes:
        packages: folders of the packages whose code is in a script.
    """

    def __init__(self, node: Node, site: Path) -> None:
        self._node = node
        self._site = site
        self.packages: set[Path] = set()

    def another(self) -> Bundler:
        """Return a bundler that notes packages of its own."""
        return Bundler(self._node, self._site)

    def modules(self) -> None:
        """Write the page's scripts, which share code in chunks, and its style sheet."""
        self._build(
            entryPoints=[{"in": path, "out": name} for name, path in SOURCES],
            outdir=str(self._site),
            format="esm",
            splitting=True,
            chunkNames="chunks/[name]-[hash]",
        )

    def script(self, output: Path, *sources: str, **constants: Any) -> None:
        """Write a script in one file that needs no module, and perhaps its style sheet beside it.

        Args:
            output: the script to write.
            sources: where it begins, and where its style sheet does, relative to this package.
            constants: values of names that stand in the source.
        """
        self._build(
            entryPoints=[{"in": source, "out": output.stem} for source in sources],
            outdir=str(output.parent),
            format="iife",
            define={name: json.dumps(value) for name, value in constants.items()},
        )

    def _build(self, **options: Any) -> None:
        constants = {"process.env.NODE_ENV": '"production"'} | options.pop("define", {})
        everything = {
            "absWorkingDir": str(HOME),
            "bundle": True,
            "minify": True,
            "metafile": True,
            "target": _TARGETS,
            "legalComments": "none",  # licences.html has them whole
            "logLevel": "warning",
            "define": constants,
            **options,
        }
        command = [*self._node.node, "--input-type=module", "-e", _API, json.dumps(everything)]
        printed = run(
            command,
            HOME,
            code="NP633",
            what="the page cannot be bundled",
            hint="if a package is missing: delete src/npchip/studio/node_modules and build again",
        )
        for made in json.loads(printed)["metafile"]["outputs"].values():
            for source, share in made["inputs"].items():
                if share["bytesInOutput"]:
                    self._note(source)

    def _note(self, source: str) -> None:
        found = re.match(r".*node_modules/(@[^/]+/)?[^/]+", source)
        if found:
            self.packages.add((HOME / found[0]).absolute())


# ---- pages


def write_index(site: Path) -> None:
    """Write the page itself, with its policy.

    Raises:
        InputError: NP633, it names a file that the site has not.
    """
    text = with_policy((PAGE / "shell" / "index.html").read_text(encoding="utf-8"), POLICY)
    for name in re.findall(r'(?:src|href)="([^"#:]+)"', text):
        if not (site / name).is_file():
            raise InputError("NP633", f"page/shell/index.html: the site has no file {name}")
    (site / "index.html").write_text(text, encoding="utf-8")


def with_policy(text: str, policy: str) -> str:
    """Return a page with a policy as the first thing after its character set.

    Raises:
        InputError: NP633, the page names no character set.
    """
    text = re.sub(r'\s*<meta\s+http-equiv="Content-Security-Policy"[^>]*>', "", text)
    meta = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
    made, count = re.subn(
        r'([ \t]*)(<meta charset="[^"]*"\s*/?>)', rf"\1\2\n\1{meta}", text, count=1
    )
    if not count:
        raise InputError("NP633", 'a page of the studio has no <meta charset="utf-8">')
    return made
