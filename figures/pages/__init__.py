"""The pictures and the page that go into the FMU and README.md."""
