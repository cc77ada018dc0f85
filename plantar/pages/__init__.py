"""The frame of a page that is written: a report, a benchmark, the assembly of a shoe."""
