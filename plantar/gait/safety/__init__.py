"""Plausible inputs, and followable commands."""
