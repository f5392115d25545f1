"""Programs on a terminal: what they print where it knows less than Unicode, and what they return."""

import codecs
import sys
import unicodedata
from collections.abc import Callable
from io import TextIOWrapper

from lidarena.base.errors import LidarenaError

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


def exit_status(work: Callable[[], object]) -> int:
    """Do the work of a program that writes when all is done; what stops it is told on standard error in a sentence.

    Args:
        work: What is to be done; it may give an exit status of its own.

    Returns:
        The work's own, else 0; 2 for a refusal, 130 after Ctrl-C.
    """
    try:
        status = work()
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return 130
    except BrokenPipeError:  # such as of lidarena list | head
        sys.stderr.close()
        return 0
    return status if isinstance(status, int) else 0


def _plain(error: UnicodeError) -> tuple[str, int]:
    """What an encoder puts in place of what it cannot encode."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(_PLAIN.get(sign) or _similar(sign) for sign in lacking), error.end


def _similar(sign: str) -> str:
    """The letters of a sign without its accents, if there are any in ASCII."""
    return unicodedata.normalize("NFKD", sign).encode("ascii", "ignore").decode() or "?"
