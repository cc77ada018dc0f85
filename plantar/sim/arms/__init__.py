"""Arms of a robot that walks: how it wears one that moves, and how that gives way to whoever takes it."""
