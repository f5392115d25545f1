"""Printing on terminals that know less than Unicode."""

import codecs
import sys
import unicodedata
from io import TextIOWrapper

_PLAIN = {
    "×": "x",
    "−": "-",
    "–": "-",
    "…": "...",
    "·": "-",
    "°": " deg",
    "η": "eta",
    "χ": "chi",
    "⁻": "^-",
    "↑": "^",
    "↓": "v",
}
_HANDLER = "lidarena.plain"


def make_output_printable() -> None:
    """Let standard output and error print something like it for what their encoding lacks, instead of an exception.

    Where ``LANG=C`` or ``PYTHONIOENCODING=ascii`` is set, × becomes x and a minus sign a hyphen; what looks like
    nothing in ASCII becomes a question mark.
    """
    codecs.register_error(_HANDLER, _plain)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)


def _plain(error: UnicodeError) -> tuple[str, int]:
    """What an encoder puts in place of what it cannot encode."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(_PLAIN.get(sign) or _similar(sign) for sign in lacking), error.end


def _similar(sign: str) -> str:
    """The letters of a sign without its accents, if there are any in ASCII."""
    return unicodedata.normalize("NFKD", sign).encode("ascii", "ignore").decode() or "?"
