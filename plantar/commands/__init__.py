"""The commands of the command line, one a file: a module with a `COMMAND`. Heavy libraries are imported inside them."""
