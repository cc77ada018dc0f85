"""Arms of a robot that walks: how it wears one that moves, and how that yields to contact."""
