"""Learned agents of the corridor family."""
