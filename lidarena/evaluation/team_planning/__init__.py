"""Experiments with plans of teams alone, without a world in which they are driven."""
