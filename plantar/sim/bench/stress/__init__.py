"""Random short runs of the whole loop in which no error may be raised and no command be nonsense."""
