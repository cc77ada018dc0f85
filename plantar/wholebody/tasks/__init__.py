"""Tasks, one a file: each gives its Jacobian and the force or acceleration along it."""
