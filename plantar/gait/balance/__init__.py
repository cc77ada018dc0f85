"""Balance: DCM feedback, CoM admittance, wrench distribution, foot admittance."""
