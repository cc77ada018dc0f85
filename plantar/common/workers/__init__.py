"""Processes and machines that run tasks: any of them may die, and no task is lost."""
