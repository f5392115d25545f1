"""What is measured of an episode, a module a family."""
