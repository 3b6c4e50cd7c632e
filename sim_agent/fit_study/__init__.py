"""The adaptation's polynomials found anew: the best gait on many grounds, and least squares through them."""
