"""SLAM: occupancy mapping, scan matching, the Rao-Blackwellised particle filter and its uncertainty criteria."""
