"""Where a sole's taxels are: layouts, tiling, and their file."""
