"""The page of the reproduction, and what of the results is kept in git."""
