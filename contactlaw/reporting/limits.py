"""Words that the reports of all scenes share: sizes of plates, and limits of the model."""

from contactlaw import explain
from contactlaw._arrays import Integers
from contactlaw._readable import drawn
from contactlaw.physical.validity import count_flags

label = drawn  # the name of a plate, also for the demo


def exceeded(flags: Integers) -> dict[str, str]:
    """Name the limits of the model that impacts exceed, with their number, and what each means."""
    counts = {flag: f"{count} impact{'s' * (count != 1)}" for flag, count in count_flags(flags).items()}
    return {f"{str(flag.name).lower().replace('_', ' ')}, {count}": explain(flag)[0] for flag, count in counts.items()}
