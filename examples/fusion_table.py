"""Write the table of the sweep ``table-2.1.yaml`` into docs/fusion.md.

python -m examples.fusion_table [FILE]
"""

from __future__ import annotations

from examples.measure import ROOT, spread, swept, table, write_page
from npchip.host.vision.fusion.registry import ALGORITHMS

PAGE = ROOT / "docs" / "fusion.md"
BEGIN, END = "<!-- python -m examples.fusion_table -->\n", "<!-- end -->\n"


def sets() -> str:
    """Return the RMS distances of sets of paths: mean and standard deviation, in metres."""
    rows = []
    for name in dict.fromkeys(swept("table-2.1")["algorithm"]):
        known = ALGORITHMS[name].thesis if name in ALGORITHMS else None
        cells = [
            spread(swept("table-2.1", setting=setting, algorithm=name)["rms"], 4)
            for setting in ("thesis", "chip")
        ]
        title = ALGORITHMS[name].title if name in ALGORITHMS else "line, 20 points"
        thesis = f"{known[2]:.4f}".removeprefix("0") if known else "–"
        rows.append([title, thesis, *(cell.replace("0.", ".") for cell in cells)])
    head = ["metres", "thesis", "fitted to the thesis", "the chip's own size"]
    return table(head, rows, 3)


def document() -> str:
    """Return the text of docs/fusion.md."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    _, _, behind = rest.partition(END)
    return f"{before}{BEGIN}\n{sets()}\n\n{END}{behind}"


if __name__ == "__main__":
    write_page("fusion.md", document)
