"""Parts of a mesh that are facets of a cylinder, a cone or a sphere."""

import math

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw.walls.edges import members, smooth_parts

_FEWEST = 18  # triangles of a part; fewer around an axis meet at more than 20 degrees
_OFF = 1e-3  # [radius] of a vertex; files in single precision, far from the origin, are within it
_FLAT = 1e-6  # share of the normals' squares, or of the size, that is rounding
# Least area of facets over that of the round wall; 18 around an axis have 0.995, a sphere of 320 0.98.
_COVERED, _COVERED_SPHERE = 0.99, 0.97


def round_parts(vertices: Array, triangles: Integers) -> list[str]:
    """Walls without facets in place of smooth parts of a mesh, the largest first, as one writes them."""
    corners = vertices[triangles]
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(areas, axis=1)
    found = []
    for some in members(smooth_parts(triangles, areas / area[:, None])):
        if len(some) < _FEWEST:
            continue
        whole, points = area[some].sum(), corners[some].reshape(-1, 3)
        shares, axes = np.linalg.eigh((areas[some].T / area[some]) @ areas[some] / whole)
        # The sum of the areas of an open cone or bowl is along its axis; of a tube it is zero.
        for axis in (areas[some].sum(axis=0), *axes.T) if shares[1] > _FLAT else ():
            length = np.linalg.norm(axis)
            if length > _FLAT * whole and (wall := _revolved(points, axis / length, whole)):
                found.append((-whole, wall))
                break
    return [wall for _, wall in sorted(found)]


def _revolved(points: Array, axis: Array, area: float) -> str:
    """Wall around an axis of this direction on which points are, if it has about this area."""
    axis = axis * np.sign(axis[np.argmax(abs(axis))])  # the same, whatever the winding
    one = np.cross(axis, np.eye(3)[np.argmin(abs(axis))])
    across, middle = np.stack((one, np.cross(axis, one))) / np.linalg.norm(one), points.mean(axis=0)
    size = abs(points - middle).max()
    (x, y), z = across @ (points - middle).T / size, (points - middle) @ axis / size
    # x^2 + y^2 = 2 c.(x, y) + a + b z + d z^2 holds for a cone and, with d = -1, for a sphere.
    columns = np.stack((2.0 * x, 2.0 * y, z, z * z, np.ones_like(z)), axis=1)
    (cx, cy, b, *_), *_ = np.linalg.lstsq(columns, x * x + y * y)
    middle, rho = middle + size * np.array([cx, cy]) @ across, np.hypot(x - cx, y - cy)
    ends, (slope, start) = np.array([z.min(), z.max()]), np.polyfit(z, rho, 1)

    def said(*numbers: float) -> str:
        return ", ".join(f"{n if abs(n) > _FLAT * size else 0.0:.6g}" for n in numbers)

    low, high, centre = (f"({said(*(middle + size * h * axis))})" for h in (*ends, 0.5 * b))
    if (abs(rho - start - slope * z) < _OFF * rho.max()).all():
        radii, least = np.maximum(start + slope * ends, 0.0), _COVERED
        whole = math.pi * radii.sum() * math.hypot(np.ptp(ends), np.ptp(radii))
        straight = int(np.ptp(radii) < _OFF * radii.max())
        wall = f"{'Cylinder' if straight else 'Cone'}({low}, {high}, {said(*size * radii[straight:])}"
    else:
        far, least = np.hypot(rho, z - 0.5 * b), _COVERED_SPHERE
        if np.ptp(far) > _OFF * np.ptp(ends):  # a large sphere is near any bumpy plate
            return ""
        whole, wall = 4.0 * math.pi * far.mean() ** 2, f"Sphere({centre}, {said(size * far.mean())}"
        if area < least * whole * size**2:
            angles = np.arccos(np.clip((ends - 0.5 * b) / far.mean(), -1.0, 1.0))
            whole *= 0.5 * np.ptp(ends) / far.mean()
            wall += f", axis=({said(*np.round(axis, 6))}), polar=({angles[1]:.4g}, {angles[0]:.4g})"
    return f"{wall}, thickness=...)" if area > least * whole * size**2 else ""
