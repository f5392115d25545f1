"""What belongs to no room: errors, files, compiled functions, random streams, YAML, keyword checks."""
