"""A control tick of walking: estimate, balance, feet."""
