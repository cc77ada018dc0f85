"""Where the taxels of a body are, and what they say together."""
