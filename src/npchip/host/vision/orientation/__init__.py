"""Position of a drone from the picture of one right triangle (thesis 3.4 and 4.1.2).

`scene` and `pictures` draw the view of a camera, `corners` finds the vertices, `dataset` keeps
both, `network` and `models` learn positions from them, `direct` computes them without learning,
`eightbit` is the network for the array, and `experiment` measures all of them (table 3.1).
"""
