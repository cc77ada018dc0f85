"""Run time against error of whole scenes: over the settings that trade one for the other, against a fine reference."""
