"""Questions about impacts, one a file, and the two ways to an answer: the table and the solver."""
