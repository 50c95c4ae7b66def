"""Colours of Okabe and Ito, told apart in every kind of colour vision, and two greys.

Apart from the figures' style, so that what draws by itself does not load matplotlib for them.
"""

GREY, BAND = "#595959", "#d9d9d9"
BLUE, ORANGE, GREEN, PURPLE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9"
