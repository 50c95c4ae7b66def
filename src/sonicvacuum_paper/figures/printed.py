"""What the paper prints for the figures alone; its other numbers stand in `sonicvacuum_paper.printed`.

The points and traces of the paper's own figures are not available; no value is read off or guessed.
"""

STEEL_SPEED = 578.0  # m/s, Fig. 3b
SPEED_ERROR = 0.10  # relative, of every measured speed; Fig. 3
COATED_BAR, STEEL_BAR = 1.0, 5.0  # length of the force bars in N; captions of Figs. 3 and 5
