"""Tasks of inverse kinematics, one a file."""
