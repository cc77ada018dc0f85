"""One page of all benchmark findings."""
