	MOV	r0, r1
	ADD	r0,	€5	; the caret stands below the sign
	HALT
