"""Artificial potential fields: Khatib's, Yang et al.'s improved one, and the one that A* guides."""

from lidarena.planning.potential_field.field_parameters import FieldParameters, field_parameters
from lidarena.planning.potential_field.potential_field import PotentialField, plan_path

__all__ = ["FieldParameters", "PotentialField", "field_parameters", "plan_path"]
