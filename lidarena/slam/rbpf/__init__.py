"""The Rao-Blackwellised particle filter: likelihood fields, scan matching, resampling."""
