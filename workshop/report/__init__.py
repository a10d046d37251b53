"""The report as a web page and as image files."""
