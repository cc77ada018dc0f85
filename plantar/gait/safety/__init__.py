"""Whether what a controller is given can be, and what it commands may be followed."""
