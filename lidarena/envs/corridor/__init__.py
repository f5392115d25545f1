"""Teams of robots on a floor plan: the corridor family."""
