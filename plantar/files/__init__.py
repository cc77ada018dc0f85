"""A file of unknown origin, read within limits: its size, its text, its archive, and libraries that run apart."""
