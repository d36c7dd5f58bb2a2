"""Types of arrays by their elements, for annotations."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Places = NDArray[np.intp]  # indices
Mask = NDArray[np.bool_]
Rows = NDArray[np.void]  # records, whose fields have names
