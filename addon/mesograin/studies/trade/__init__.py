# The trade of error for time: our models, and Cycles itself, against one converged reference.
