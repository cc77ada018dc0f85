"""Written files: drawing, picture, bill of parts, printable files."""
