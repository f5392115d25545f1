"""Simple temporal networks, with uncertainty: consistency, dynamic controllability, dispatch, files and pictures.

A library of its own: of this package it needs only the errors, the files and the compiler's settings.
"""

from lidarena.temporal.controllability import Controllability, check_controllability, require_controllable
from lidarena.temporal.dispatchable import DispatchableNetwork, Wait, make_dispatchable
from lidarena.temporal.edges import ContingentLink, NegativeCycle, TemporalEdge
from lidarena.temporal.execution import RealTimeExecution, TimeWindow, run_to_the_end, violated
from lidarena.temporal.graph_views import draw, to_networkx
from lidarena.temporal.graphml import read_graphml, write_graphml
from lidarena.temporal.plain_text import read_plain_stnu, write_plain_stnu
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

__all__ = [
    "STN",
    "STNU",
    "ContingentLink",
    "Controllability",
    "DispatchableNetwork",
    "NegativeCycle",
    "RealTimeExecution",
    "TemporalEdge",
    "TimeWindow",
    "Wait",
    "check_controllability",
    "draw",
    "make_dispatchable",
    "read_graphml",
    "read_plain_stnu",
    "require_controllable",
    "run_to_the_end",
    "to_networkx",
    "violated",
    "write_graphml",
    "write_plain_stnu",
]
