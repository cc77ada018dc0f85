"""Readings over time: recordings in memory and in MCAP files."""
