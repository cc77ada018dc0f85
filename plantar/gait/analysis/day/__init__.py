"""A day of insoles: what its wearer did, and what the feet carried, by the hour."""
