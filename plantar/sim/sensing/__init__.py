"""What the robot's sensors read of the simulated truth."""
