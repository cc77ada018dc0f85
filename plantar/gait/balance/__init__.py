"""How to keep balance: DCM feedback, CoM admittance, wrench distribution, foot admittance."""
