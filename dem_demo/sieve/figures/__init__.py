"""Figures of a sieve: each file draws one."""
