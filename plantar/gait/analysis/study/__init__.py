"""A study: a folder of recordings, the table of its participants, and differences between conditions."""
