"""The impact record of all engines: its columns, and how a model fills them."""

from contactlaw.record.columns import COLUMNS, IMPACT, OBSERVED, Column, Kind, fill, only_impacts

__all__ = ["COLUMNS", "IMPACT", "OBSERVED", "Column", "Kind", "fill", "only_impacts"]
