"""The stress run: odd readings for every function of the perception."""
