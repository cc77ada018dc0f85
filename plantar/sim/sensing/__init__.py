"""The robot's sensors: what they read of the simulated truth."""
