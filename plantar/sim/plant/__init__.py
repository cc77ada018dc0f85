"""Differences of the true robot, sensors and ground from the controller's model."""
