"""What the robot's sensors say of the simulated truth."""
