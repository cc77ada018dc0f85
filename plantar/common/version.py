"""The version of the distribution: `plantar.__version__`."""

# Read by the build, the root and every page that states the version.
VERSION = "0.1.0"
