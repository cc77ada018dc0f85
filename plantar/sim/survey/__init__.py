"""A robot introduced: its files, checked by plans and decided by a trial walk."""
