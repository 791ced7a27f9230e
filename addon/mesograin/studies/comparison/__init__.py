# The comparison: every model beside the Cycles render that means the same, in pictures and numbers.
