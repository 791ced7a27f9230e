# What the commands of the add-on share: their options and values, one sentence for what is wrong, a clean end.
