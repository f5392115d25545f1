"""Potential fields and A* as policies of the arena family."""
