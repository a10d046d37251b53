"""Between sticking and sliding: which regime a scene is in, and its mean force."""
