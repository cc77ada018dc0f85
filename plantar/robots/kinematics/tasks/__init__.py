"""Tasks of inverse kinematics, one a file: each states its error and its Jacobian."""
