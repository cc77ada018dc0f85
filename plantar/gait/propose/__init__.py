"""Plan changes by footholds, ground shape, pushes and commands."""
