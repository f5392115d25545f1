"""Colours that the colour-blind can tell apart (Okabe and Ito, Color Universal Design), and dashes for grey prints."""

BLUE, VERMILION, GREEN, PINK, AMBER, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#555555"
RED, VIOLET = "#CC0000", "#7A5195"
_DASHES = ("-", "--", "-.", ":")
LINES = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (PINK, ":"), (AMBER, "-"), (GREY, "--"))
"""Colour and dashes of each line of a picture."""


def line_of(place: int) -> tuple[str, str]:
    """Colour and dashes of the line at a place; beyond the last colour they begin anew with other dashes."""
    colour, dashes = LINES[place % len(LINES)]
    return colour, _DASHES[(_DASHES.index(dashes) + place // len(LINES)) % len(_DASHES)]
