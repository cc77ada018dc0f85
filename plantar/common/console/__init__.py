"""Command line without commands: options, progress, and endings."""
