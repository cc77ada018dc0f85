"""A study: a folder of recordings, the table of who walked in which condition, and what differs between conditions."""
