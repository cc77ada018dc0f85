"""Sensor cells: skin, film with tail, electrode sheet; built-in ones as TOML."""
