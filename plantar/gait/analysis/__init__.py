"""Analysis of recorded gait: events, parameters, figures, report."""
