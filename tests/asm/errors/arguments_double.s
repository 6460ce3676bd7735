.macro m0, a
        m1      a + a
.endm
.macro m1, a
        m2      a + a
.endm
.macro m2, a
        m3      a + a
.endm
.macro m3, a
        m4      a + a
.endm
.macro m4, a
        m5      a + a
.endm
.macro m5, a
        m6      a + a
.endm
.macro m6, a
        m7      a + a
.endm
.macro m7, a
        m8      a + a
.endm
.macro m8, a
        m9      a + a
.endm
.macro m9, a
        m10      a + a
.endm
.macro m10, a
        m11      a + a
.endm
.macro m11, a
        m12      a + a
.endm
.macro m12, a
        m13      a + a
.endm
.macro m13, a
        m14      a + a
.endm
.macro m14, a
        m15      a + a
.endm
.macro m15, a
        m16      a + a
.endm
.macro m16, a
        m17      a + a
.endm
.macro m17, a
        m18      a + a
.endm
.macro m18, a
        m19      a + a
.endm
.macro m19, a
        m20      a + a
.endm
.macro m20, a
        m21      a + a
.endm
.macro m21, a
        m22      a + a
.endm
.macro m22, a
        m23      a + a
.endm
.macro m23, a
        m24      a + a
.endm
.macro m24, a
        MOV     r0, #a
.endm
        m0      1
        HALT
