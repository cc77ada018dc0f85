"""The command line without its commands: options, progress, and how a command ends."""
