"""One scenario from scene to summary, and many of them."""
