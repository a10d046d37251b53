"""The figures of the paper and of the regimes, and the page that shows them."""
