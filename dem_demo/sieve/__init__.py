"""``dem-demo sieve``: beads fall on a perforated deck of thin sheet that vibrates."""
