"""Planning on arrays: grid search, inflation, frontiers, steering and path following."""
