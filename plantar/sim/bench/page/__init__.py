"""One page that shows what the benchmarks found: kernels, papers, scenes, run time against error."""
