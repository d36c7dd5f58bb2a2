"""Figures of any bed: each file draws one, under the law and with a constant COR."""
