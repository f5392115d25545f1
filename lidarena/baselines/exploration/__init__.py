"""Frontier exploration and its relatives as policies of the exploration family."""
