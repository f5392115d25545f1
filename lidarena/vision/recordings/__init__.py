"""Recorded stereo sequences, and how far an odometry is off on them."""
