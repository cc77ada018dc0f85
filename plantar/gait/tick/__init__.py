"""Stages of a control tick, joining the rooms' files."""
