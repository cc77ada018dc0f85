"""Recording in the browser, without network."""
