"""``npchip studio``: serve the page, build it, or write it as static files."""

from __future__ import annotations

import os
import sys
import threading
from typing import TYPE_CHECKING, Final

import click

from npchip.base.errors import InputError
from npchip.cli.options import Whole, path_option
from npchip.cli.output import emit

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.studio.serve import Server

PORT: Final = 8064
"""The usual port: what a browser keeps belongs to an address, so it should stay the same."""


@click.command("studio")
@click.option(
    "--port",
    type=Whole(0, 65535),
    metavar="N",
    help=f"Where to serve it; 0 for any free port.  [default: {PORT}, or a free one]",
)
@click.option("--no-browser", is_flag=True, help="Do not open a browser.")
@click.option("--build", is_flag=True, help="Build the page first; in a clone only.")
@path_option(
    "--export",
    "folder",
    metavar="DIR",
    help="Write the page as files for any web server, and serve nothing.",
)
def command(port: int | None, no_browser: bool, build: bool, folder: Path | None) -> None:
    """Serve the studio on this computer: a page to write, run and step programs.

    Only this computer can open it. Nothing is loaded from elsewhere, and the browser keeps the
    page: once opened, it works without npchip. Ctrl-C ends the server.

    \b
    Examples:
      npchip studio
      npchip studio --port 9000 --no-browser
      npchip studio --export page          writes it for a web server
      npchip studio --build                builds it first, with Node.js
    """
    from npchip.studio.places import need_site

    if folder is not None:
        from npchip.studio.site import check_target

        if port is not None:
            raise InputError("NP244", "--export serves nothing, so it does not go with --port")
        check_target(folder)
    if build:
        _build()
    site = need_site()
    if folder is not None:
        emit(_export(folder))
        return
    if not build:
        note_age(site)
    with start_server(site, port) as server:
        emit(f"npchip studio: {server.address}\n")
        click.echo("Press Ctrl-C to stop.", err=True)
        sys.stdout.flush()
        if not no_browser:
            open_browser(server.address)
        server.serve_forever()


def _build() -> None:
    from npchip.studio.build import build

    if not build(lambda line: click.echo(line, err=True)):
        click.echo("the page is up to date", err=True)


def note_age(site: Path) -> None:
    """Say in a clone that the page is older than what it was made from."""
    from npchip.studio.places import is_clone, known_version

    if is_clone():
        from npchip.studio.build import sources

        if known_version(site).get("sources") != sources():
            click.echo(
                "note: files have changed since the page was built: npchip studio --build", err=True
            )


def _export(folder: Path) -> str:
    from npchip.studio.site import export_site

    count, size = export_site(folder)
    return (
        f"{folder}: {count} files, {size / 1e6:.1f} MB; any web server can serve them\n"
        f"Try it: python -m http.server --bind 127.0.0.1 --directory {folder}\n"
    )


def start_server(site: Path, port: int | None) -> Server:
    """Return a server at a port; at the usual one, or any, if none was asked for.

    Raises:
        InputError: NP634, the port that was asked for cannot be used.
    """
    from npchip.studio.serve import Server

    if port is not None:
        return Server(site, port)
    try:
        return Server(site, PORT)
    except InputError:
        click.echo(
            f"note: port {PORT} is in use, so this is another address: programs that a browser"
            " keeps belong to one",
            err=True,
        )
        return Server(site)


def open_browser(address: str) -> None:
    """Open the page in a browser with a window; one in this terminal would be in the way."""
    if sys.platform not in {"win32", "darwin"} and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    ):
        return
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
