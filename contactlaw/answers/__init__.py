"""Answers about impacts, by lookup in a table or by the solver, and what is made of them."""
