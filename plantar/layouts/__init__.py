"""Where the taxels of a sole are: layouts, how they are tiled, and their file."""
