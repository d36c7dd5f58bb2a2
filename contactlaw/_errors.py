"""The error about an argument: every layer raises it, and whoever took the argument can name it."""

import numpy as np


class ArgumentError(ValueError):
    """An argument was refused: which one, what it was, and why.

    Attributes
    ----------
    name : str
        Name of the argument, or several, separated by commas.
    value : object
        What was given; None if the reason says it, or if the argument was left out.
    reason : str
        What would be right, or what to do.
    element : int or None
        Index of the value in an array that was given.

    Examples
    --------
    >>> raise ArgumentError("speed", -1.0, "must be positive [m/s]", 3)
    Traceback (most recent call last):
    contactlaw._errors.ArgumentError: speed: got -1.0 (element 3); must be positive [m/s]
    """

    def __init__(self, name: str, value: object, reason: str, element: int | None = None) -> None:
        value = value.item() if isinstance(value, np.number) else value
        super().__init__(name, value, reason, element)  # the arguments as given: pickle needs them
        self.name, self.value, self.reason, self.element = name, value, reason, element

    def __str__(self) -> str:
        return f"{self.name}: {self.complaint}"

    @property
    def complaint(self) -> str:
        """The message without the name."""
        at = "" if self.element is None else f" (element {self.element})"
        return self.reason if self.value is None else f"got {self.value!r}{at}; {self.reason}"
