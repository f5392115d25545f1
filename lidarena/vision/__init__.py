"""Stereo vision: cameras, a virtual seabed and its pictures, features, and visual odometry.

Cameras look along their z axis, x to the right and y down in the image. Motions are written in column form: the motion
from frame a to frame b takes coordinates of one to the other, ``X_b = R X_a + t``; poses are camera to world. Bobkov et
al. write rows instead.
"""
