"""What the time of a scene goes to, how it compares with the physics alone, and what is skipped."""
