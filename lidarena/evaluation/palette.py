"""Colours that the colour-blind can tell apart (Okabe and Ito, Color Universal Design), and dashes for grey prints."""

BLUE, VERMILION, GREEN, PINK, AMBER, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#555555"
RED, VIOLET = "#CC0000", "#7A5195"
LINES = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (PINK, ":"), (AMBER, "-"), (GREY, "--"))
"""Colour and dashes of each line of a picture."""
