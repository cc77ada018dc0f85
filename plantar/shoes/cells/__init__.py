"""Sensor cells: skin, a film sensor with its tail, a sheet of electrodes; the built-in ones as TOML."""
