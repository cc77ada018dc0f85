"""Tasks, one a file: Jacobian, and force or acceleration."""
