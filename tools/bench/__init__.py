"""Speed against accuracy and stability, measured."""
