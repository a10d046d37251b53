"""The web site of the project: its Markdown pages, the playground and the Python API, by Sphinx."""
