"""Machines with skin on any of their links, and the experiments of whole-body skin tasks on them."""
