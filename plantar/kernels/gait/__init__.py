"""Control tick of walking: estimate, balance, feet."""
