"""Taxels on the shoe's face."""
