"""Types of arrays by their elements, for annotations; and what compares arrays."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Places = NDArray[np.intp]  # indices
Mask = NDArray[np.bool_]
Rows = NDArray[np.void]  # records, whose fields have names


class ByValue:
    """Dataclass with fields that may be arrays: equal if shapes and elements are, and hashed by them."""

    def _values(self) -> Any:
        return tuple((np.shape(field), *np.ravel(field).tolist()) for field in vars(self).values())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, type(self)) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())
