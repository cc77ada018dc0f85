"""What scenes' experiments show, by the judge's truth: one criterion a file."""
