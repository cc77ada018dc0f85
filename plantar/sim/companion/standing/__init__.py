"""A machine that stands on its feet: how it knows where it is, what presses on it, and how it is judged."""
