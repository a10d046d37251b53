"""What to set for a scene and an accuracy, and how to couple the contact to a mass."""
