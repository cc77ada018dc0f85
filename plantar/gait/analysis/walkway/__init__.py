"""Footsteps of walkways and stacks, measured one by one: recordings of any size."""
