"""A module that cannot be imported."""

from lidarena.evaluation import NoSuchName  # type: ignore[attr-defined]  # noqa: F401

MEASURES = None
