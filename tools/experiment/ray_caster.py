"""An independent ray caster of sonar images: one ray through each (azimuth, elevation) cell, by numpy alone.

Sonar axes: x to starboard, y up, z backwards. Azimuth is atan2(x, -z), elevation asin(y / r). A triangle is held
against the rays of the cells about it; the nearest hit of each ray stays.
"""
import numpy as np


def nearest_hits(triangles, azimuth_deg, elevation_deg, columns, rows):
    """Two arrays [rows, columns]: metres to the first surface (inf where a ray meets none), and the cosine of
    incidence there. triangles: [n, 3, 3], metres."""
    half_a, half_e = np.radians(azimuth_deg) / 2, np.radians(elevation_deg) / 2
    azimuths = -half_a + (np.arange(columns) + 0.5) * 2 * half_a / columns
    elevations = -half_e + (np.arange(rows) + 0.5) * 2 * half_e / rows
    ranges, cosines = np.full((rows, columns), np.inf), np.zeros((rows, columns))
    length = np.linalg.norm(triangles, axis=2)
    azimuth = np.arctan2(triangles[..., 0], -triangles[..., 2])
    elevation = np.arcsin(np.clip(triangles[..., 1] / np.maximum(length, 1e-12), -1, 1))
    # Lines bulge between corners in these angles; a margin of a tenth of the extent, and a cell, covers that.
    def cells(low, high, half, count):
        margin = 0.1 * (high - low) + 2 * half / count
        first = np.floor((low - margin + half) / (2 * half) * count).astype(int)
        last = np.ceil((high + margin + half) / (2 * half) * count).astype(int)
        return np.clip(first, 0, count), np.clip(last, 0, count)

    a0, a1 = cells(azimuth.min(axis=1), azimuth.max(axis=1), half_a, columns)
    e0, e1 = cells(elevation.min(axis=1), elevation.max(axis=1), half_e, rows)
    seen = (a1 > a0) & (e1 > e0) & (triangles[..., 2] < 0).all(axis=1)
    cos_e, sin_e = np.cos(elevations), np.sin(elevations)
    sin_a, cos_a = np.sin(azimuths), np.cos(azimuths)
    for corners, left, right, low, high in zip(triangles[seen], a0[seen], a1[seen], e0[seen], e1[seen]):
        ray = np.empty((high - low, right - left, 3))
        ray[..., 0] = cos_e[low:high, None] * sin_a[left:right]
        ray[..., 1] = sin_e[low:high, None]
        ray[..., 2] = -cos_e[low:high, None] * cos_a[left:right]
        hit = _hits(ray, corners)
        part = ranges[low:high, left:right]
        nearer = hit < part
        part[nearer] = hit[nearer]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        cosines[low:high, left:right][nearer] = np.abs(ray[nearer] @ (normal / np.linalg.norm(normal)))
    return ranges, cosines


def _hits(ray, corners):
    """Metres along unit rays from the origin to a triangle (Moeller and Trumbore 1997), inf where they miss."""
    a = corners[0]
    edge_b, edge_c = corners[1] - a, corners[2] - a
    p = np.cross(ray, edge_c)
    det = p @ edge_b
    with np.errstate(divide="ignore", invalid="ignore"):
        u = -(p @ a) / det
        q = np.cross(-a, edge_b)
        v = ray @ q / det
        t = (q @ edge_c) / det
        inside = (np.abs(det) > 1e-15) & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 0)
    return np.where(inside, t, np.inf)


def sonar_image(ranges, cosines, range_m, bins, columns):
    """[bins, columns]: the mean cosine over a column's rays, by range bin: the published model's intensity.
    ranges, cosines: nearest_hits with a multiple of these columns."""
    rows, fine = ranges.shape
    column = np.broadcast_to((np.arange(fine) * columns) // fine, ranges.shape)
    bin_of = np.floor((ranges - range_m[0]) / (range_m[1] - range_m[0]) * bins)
    inside = np.isfinite(bin_of) & (bin_of >= 0) & (bin_of < bins)
    image = np.zeros((bins, columns))
    np.add.at(image, (bin_of[inside].astype(int), column[inside]), cosines[inside])
    return image / (rows * fine / columns)
