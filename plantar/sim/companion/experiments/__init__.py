"""The companion's experiments, one a file."""
