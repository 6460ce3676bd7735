"""Pack the extension of VS Code.

    python -m docs.editors [FILE.vsix]

npm fetches its packages once; the extra ``studio`` brings Node.js where there is none. Exit code 2:
it cannot be packed here.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

from npchip.base.errors import NpchipError
from npchip.studio.node import fetch_packages, find_node, run

EXTENSION: Final = Path(__file__).parent / "vscode"
OLDEST: Final = 22
"""Oldest major version of Node.js that packs it."""


def main(arguments: list[str]) -> int:
    """Pack the extension and return the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m docs.editors", description="Pack the extension of VS Code."
    )
    parser.add_argument("file", nargs="?", type=Path, default=Path("npchip.vsix"))
    file: Path = parser.parse_args(arguments).file.absolute()
    try:
        node = find_node(OLDEST)
        fetch_packages(node, EXTENSION)
        run(
            [*node.node, str(EXTENSION / "build.mjs"), str(file)],
            EXTENSION,
            code="NP633",
            what="the extension cannot be packed",
            hint="if a package is missing: delete docs/editors/vscode/node_modules and try again",
        )
    except NpchipError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    print(f"{file}: {file.stat().st_size / 1e3:.0f} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
