"""What really happened: the judge and what it sees. No controller imports it."""
