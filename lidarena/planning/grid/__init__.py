"""Planning for one robot on an occupancy grid: inflation, search, frontiers, path following, steering."""
