"""What is concluded from the hypotheses that were tried: where, what, how sure, what else, what is left."""
