"""The papers that this project follows: presets and experiments."""
