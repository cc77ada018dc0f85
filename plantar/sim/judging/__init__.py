"""What really happened: the judge and its truth; no controller imports it."""
