"""Wiring of a shoe's cells: nets, harness, flexible board, read-out and its firmware."""
