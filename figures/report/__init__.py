"""The figures of the paper, the regimes and the identification, and the page that shows them."""
