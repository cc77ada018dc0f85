"""Machines with skin on any link, and experiments of whole-body skin tasks."""
