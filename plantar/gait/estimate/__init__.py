"""State of the body: floating base, loads, command frame."""
