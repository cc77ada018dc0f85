"""A recording in the browser: one page that needs no network."""
