"""A fit as lines of text and as JSON."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlaw._readable import percent, rounded, scale_of, with_error
from contactlaw.cli.parts.impacts import aligned, flag_names
from contactlaw.fitting import Fit
from contactlaw.fitting.unknowns import UNKNOWNS


def text(found: Fit) -> Iterator[str]:
    """Lines for a terminal: each value with its error and the error's parts, residuals, notes."""
    width = max(len(UNKNOWNS[name].title) for name in found.unknown)
    for name in found.unknown:
        _, size = scale_of(max(abs(found.values[name]), found.errors[name]), UNKNOWNS[name].unit)
        data, model = found.statistical_errors[name] / size, found.model_errors[name] / size
        yield f"{UNKNOWNS[name].title:{width}s}  {_number(found, name)}"
        by_law = rounded(model) if np.isfinite(model) else "nothing known"
        yield f"{'':{width}s}  of it {rounded(data)} from the data, {by_law} from the model"
    for n, name in enumerate(found.unknown):
        for m in range(n):
            yield f"correlation of {found.unknown[m]} and {name}: {found.correlation[n, m]:.2f}"
    for kind, off in found.residuals.items():
        what, many = kind.replace("_", " "), "s" * (off.size > 1)
        share = percent(found.scatter[kind])
        yield f"{what}: {off.size} value{many}, {share} off the fit (rms)"
    if found.notes:
        yield ""
    yield from found.notes


def values_in_words(found: Fit) -> list[str]:
    """Title, value and error of each unknown."""
    return [f"{UNKNOWNS[name].title} {_number(found, name)}" for name in found.unknown]


def _number(found: Fit, name: str) -> str:
    return with_error(found.values[name], found.errors[name], UNKNOWNS[name].unit).rstrip()


def rows(found: Fit) -> Iterator[str]:
    """Lines for a terminal: a row per rebound, with its line of the file."""
    kinds = list(found.residuals)
    cells: dict[str, list[str]] = {kind: ["-"] * len(found.data) for kind in kinds}
    for kind in kinds:
        for row, off in zip(found.rows[kind].tolist(), found.residuals[kind].tolist(), strict=True):
            cells[kind][row] = f"{100.0 * off:+z.2f}"
    slides = found.data.sliding_speed
    angle = [] if slides is None else np.degrees(np.arctan2(slides, found.data.speed)).tolist()
    yield from aligned(
        [
            ["rebound", "", *(str(n) for n in range(len(found.data)))],
            ["line", "", *(f"{n:.0f}" for n in np.asarray(found.data.line).tolist())],
            ["speed", "[m/s]", *(f"{v:.4g}" for v in np.asarray(found.data.speed).tolist())],
            *([["angle", "[deg]", *(f"{a:.4g}" for a in angle)]] if angle else []),
            *([kind.replace("_", " "), "[% off]", *cells[kind]] for kind in kinds),
            ["flags", "", *(", ".join(flag_names(flags)) for flags in found.flags.tolist())],
        ]
    )


def record(found: Fit) -> dict[str, Any]:
    """All of a fit for JSON, in SI units."""
    return {
        "values": found.values,
        "errors": found.errors,
        "statistical_errors": found.statistical_errors,
        "model_errors": {k: e if e < np.inf else None for k, e in found.model_errors.items()},
        "units": {name: UNKNOWNS[name].unit for name in found.unknown},
        "correlation": found.correlation.tolist(),
        "alternatives": list(found.alternatives),
        "residuals": {kind: off.tolist() for kind, off in found.residuals.items()},
        "rows": {kind: row.tolist() for kind, row in found.rows.items()},
        "scatter": found.scatter,
        "flags": [flag_names(flags) for flags in found.flags.tolist()],
        "notes": list(found.notes),
        "law": found.law,
    }
