"""``python -m npchip``."""

from npchip.cli.main import main

main()
