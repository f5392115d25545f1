"""Planning for teams of robots on a grid: prioritized, coordinated and optimal (Bennewitz & Burgard 2000)."""
