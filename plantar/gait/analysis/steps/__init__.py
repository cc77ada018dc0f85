"""One step: events and measures."""
