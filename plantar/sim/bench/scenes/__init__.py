"""Run time against error of whole scenes, next to a fine reference."""
