"""The friction law of a contact under vibration, as a function."""
