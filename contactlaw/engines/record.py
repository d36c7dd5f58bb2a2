"""The impact record of all engines: its columns, and how a model fills them."""

from contactlaw.record.columns import COLUMNS as COLUMNS
from contactlaw.record.columns import IMPACT as IMPACT
from contactlaw.record.columns import OBSERVED as OBSERVED
from contactlaw.record.columns import Column as Column
from contactlaw.record.columns import Kind as Kind
from contactlaw.record.columns import fill as fill
from contactlaw.record.columns import only_impacts as only_impacts
