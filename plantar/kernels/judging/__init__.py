"""What the judge of a walk looks at after each physics step and tick."""
