"""Taxels on the face of the shoe: lattice fit and its bound."""
