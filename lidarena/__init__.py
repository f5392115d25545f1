"""Lidarena: 2D robot worlds with lidar and SLAM in the loop, learned agents and classical baselines on one interface."""
