"""Run time against error of the perception next to other libraries."""
