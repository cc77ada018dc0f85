"""A machine that stands on its feet: state, contacts, judge."""
