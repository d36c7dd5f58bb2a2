"""Figures of a rain: each file draws one."""
