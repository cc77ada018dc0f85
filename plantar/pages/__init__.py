"""The frame of a written page: a report, a benchmark, the assembly of a shoe."""
