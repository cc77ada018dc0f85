"""What every room uses: checks of arguments and arrays, files of any origin, settings, tables, pages, console."""
