"""Differences of the true robot, its sensors and the ground from the controller's model."""
