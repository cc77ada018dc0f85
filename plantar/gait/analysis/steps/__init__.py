"""One step: its events, and what it measures."""
