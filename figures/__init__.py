"""The report, the pictures of the pages and of the measurements. It imports tools/; nothing imports it."""
