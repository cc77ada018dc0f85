"""Readers of recordings, one vendor a file."""
