; it spreads round corners: read all four neighbours from mine, collect in near
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
        MOV     near, mine
        NBR     t, mine, north
        OR      near, t
        NBR     t, t, east
        OR      near, t
        NBR     t, t, south
        OR      near, t
        NBR     t, t, west
        OR      near, t
        OUT     0, near
        JMP     frame
