"""Frame of written pages: reports, benchmarks, shoe assembly."""
