"""Contacts of the simulation as forces on a sole and its taxels."""
