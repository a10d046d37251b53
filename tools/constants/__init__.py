"""What the solver's constants come from: each module is run by hand and prints or writes some of them."""
