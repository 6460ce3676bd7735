"""``npchip`` and ``python -m npchip``: signals are seen to before anything else is imported."""

from __future__ import annotations

from npchip.cli.interrupts import end_at_once

end_at_once()


def main() -> None:
    """Run the command line."""
    from npchip.cli.main import main as run  # noqa: PLC0415 - signals come first

    run()


if __name__ == "__main__":
    main()
