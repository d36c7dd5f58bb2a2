"""``dem-demo sieve``: beads fall on a vibrating, perforated deck of sheet metal."""
