"""The world: floor plans, pymunk physics, robots, lidar, noise and drawing."""
