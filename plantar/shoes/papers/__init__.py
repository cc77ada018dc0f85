"""What is written: drawing, picture, bill of parts, printable files."""
