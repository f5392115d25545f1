"""Learned agents of the exploration family."""
