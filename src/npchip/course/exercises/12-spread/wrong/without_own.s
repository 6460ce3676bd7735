; an NP with a dark pixel of its own counts too: near begins with a copy of mine
.output near, 0, plane
.reg pixel, r0
.reg value, r1
.reg mine, r2
.reg near, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     mine, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   mine, #255
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     near, #0
        NBR     t, mine, north
        OR      near, t
        NBR     t, mine, east
        OR      near, t
        NBR     t, mine, south
        OR      near, t
        NBR     t, mine, west
        OR      near, t
        OUT     0, near
        JMP     frame
