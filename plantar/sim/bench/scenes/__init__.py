"""Run time against error of scenes, next to a fine reference."""
