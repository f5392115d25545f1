"""Recorded logs: reading them, replaying them through the filter, and measuring what came out."""
