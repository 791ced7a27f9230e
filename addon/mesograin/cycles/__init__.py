# The Cycles side: materials that mean the same there, and the reference renders made of them.
