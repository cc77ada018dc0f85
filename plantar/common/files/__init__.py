"""Files of unknown origin, read within limits."""
