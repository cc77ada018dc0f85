"""Where the feet are commanded to be, how they swing and how they land."""
