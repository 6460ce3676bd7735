"""The programs that are rewritten for another chip, and what changes in them."""

from __future__ import annotations

from examples.studies.study import Edit, Study

SERIAL = "serial.yaml"
LARGE = ("rom_1024.yaml", "rom_1024_conservative.yaml")

PRODUCT = Edit(
    "asm/lib/farthest_place.s",
    ".bit:   SHR     u, #1\n",
    "        JANY    NE, .bit\n",
    """\
        MOV     t, u            ; t:w := u * w
        MUL     t, w
        ADD     g, w
        ADC     G, t
        MUL     u, W            ; its low byte counts 256
        ADD     G, W
""",
)
"""g:G := g:G + u * w:W, in the programs that search for farthest points."""

MULTIPLIED = {
    "correlate": Study(
        "asm/correlate.s",
        (
            Edit(
                "asm/correlate.s",
                "        SHR     number, #1\n",
                "        .endr\n",
                """\
        MOV     top, f
        MUL     top, number
""",
            ),
        ),
        "mul.yaml",
        ("default", SERIAL),
    ),
    **{
        name: Study(f"asm/{name}.s", (PRODUCT,), "mul.yaml", ("default", SERIAL))
        for name in ("keypoints_farthest", "polygons", "orientation")
    },
    "fusion_lut": Study(
        "asm/fusion_lut.s",
        (
            Edit(
                "asm/fusion_lut.s",
                ".sum:   MOV     p0, #0\n",
                "        .endr\n",
                """\
.sum:   MOV     p1, h
        MOV     p0, d0
        MUL     p1, p0
        MOV     p2, h
        MOV     t, d1
        MUL     p2, t
        ADD     p1, t
        ADC     p2, #0
        MUL     h, d2           ; its low byte counts 65,536
        ADD     p2, d2
""",
            ),
        ),
        "mul.yaml",
        ("default", SERIAL),
    ),
}
"""Programs with ``MUL``, by their names."""

DIFFERENCE = Study(
    "examples/studies/block_matching.s",
    (
        Edit(
            "examples/studies/block_matching.s",
            "        SUB     f, b\n",
            "        END\n",
            "        ABSD    f, b\n",
        ),
    ),
    "../absd/absd.yaml",
)
"""Block matching with ``ABSD``."""

UNROLLED = Study(
    "examples/studies/block_matching.s",
    (
        Edit(
            "examples/studies/block_matching.s",
            "        MOV     p, #0\n        MOV     w, start\n.line:",
            "        JANY    LO, .line\n",
            """\
        MOV     w, start
        .rept 64, number
        LD      f, [w + WINDOW]
        LD      b, [BEFORE + number]
        add_difference
        .if number & 7 == 7
        ADD     w, #2 * REACH + 1
        .else
        ADD     w, #1
        .endif
        .endr
""",
        ),
    ),
    machines=LARGE,
)
"""Block matching with a ROM twice as large: no loop over the pixels of a block."""
