# The Match to Picture panel: a picture, a background job, the coefficients that it found, and a button that takes them.
