"""Files of unknown origin, read within limits of size, text, archive and separate processes."""
