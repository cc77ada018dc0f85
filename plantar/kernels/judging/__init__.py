"""What the judge of a walk follows physics step by physics step, and tick by tick."""
