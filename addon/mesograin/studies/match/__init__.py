# The coefficients of a grain whose picture is nearest to a given one.
