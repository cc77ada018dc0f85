"""Taxels on the shoe's face: lattice fit and bound."""
