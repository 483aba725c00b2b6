"""Recomputes columns and tidal volume from an exported motion, independently of the server.

Usage: columns_from_files.py MOTION.msh BEGINNING: the bodies diaphragm, diaphragm-middle and chest-wall from rest
[Gmsh 2.2, mm], and the time at which the measured breath begins [s]. Prints one line: how far the diaphragm descends
below its height at the beginning of the breath, at the most, in the columns at the right apex, 40 mm behind it, at the
left apex and behind that [mm]; and the range of the cavity's volume [l].
"""
import sys

import numpy as np


def read(path):
    """Returns the triangles of each body by its name, and a list of times with the positions of all nodes."""
    names, nodes, triangles, frames = {}, None, {}, []
    with open(path) as lines:
        for line in lines:
            if line.startswith("$PhysicalNames"):
                for _ in range(int(next(lines))):
                    _, tag, name = next(lines).split(maxsplit=2)
                    names[int(tag)] = name.strip().strip('"')
            elif line.startswith("$Nodes"):
                nodes = table(lines, int(next(lines)))
            elif line.startswith("$Elements"):
                rows = table(lines, int(next(lines))).astype(int)
                triangles = {names[tag]: rows[rows[:, 3] == tag, -3:] - 1 for tag in names}
            elif line.startswith("$NodeData"):
                head = [next(lines).strip() for _ in range(8)]
                frames.append((float(head[3]), nodes[:, 1:] + table(lines, int(head[7]))[:, 1:]))
    return triangles, frames


def table(lines, count):
    return np.array([next(lines).split() for _ in range(count)], dtype=float)


def top_of_column(points, faces, at):
    """Height of the highest crossing of a vertical line."""
    a, b, c = (points[faces[:, k], :] for k in range(3))
    u, w, p = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2], at - a[:, :2]
    area = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (p[:, 0] * w[:, 1] - p[:, 1] * w[:, 0]) / area
        t = (u[:, 0] * p[:, 1] - u[:, 1] * p[:, 0]) / area
    hit = (s >= 0) & (t >= 0) & (s + t <= 1)
    return (a[:, 2] + s * (b - a)[:, 2] + t * (c - a)[:, 2])[hit].max()


def section_area(ring):
    """Area of a polygon in the plane of x and y."""
    x, y = ring[:, 0], ring[:, 1]
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def columns_of(points):
    for side in (-1, 1):
        beside = side * points[:, 0] > 35
        apex = points[beside][points[beside][:, 2].argmax(), :2]
        yield apex
        yield apex + [0, 40]


def swept(before, after, faces):
    """Volume that a moving surface sweeps: prisms between its triangles, as three tetrahedra each."""
    a, b, c = (before[faces[:, k]] for k in range(3))
    d, e, f = (after[faces[:, k]] for k in range(3))

    def tetrahedra(p, q, r, s):
        return np.einsum("ij,ij->i", q - p, np.cross(r - p, s - p)) / 6

    return tetrahedra(a, b, c, d) + tetrahedra(b, c, d, e) + tetrahedra(c, d, e, f)


def border_height(sheet, faces, azimuth, middle):
    """Height of a sheet's border at azimuths about its middle."""
    edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    border = sheet[np.unique(unique[count == 1])]
    turn = np.arctan2(border[:, 1] - middle[1], border[:, 0] - middle[0])
    order = turn.argsort()
    return np.interp(azimuth, turn[order], border[order, 2], period=2 * np.pi)


def cavity(triangles, rest):
    """Returns a function of positions before and after: the growth of the cavity between them [l]."""
    wall, sheet = triangles["chest-wall"], triangles["diaphragm-middle"]
    on_sheet = rest[np.unique(sheet)]
    middle = (on_sheet.min(axis=0) + on_sheet.max(axis=0)) / 2
    finer, steps = wall, []
    x = rest
    for _ in range(2):  # halves every edge, so that the border cuts few triangles
        steps.append(finer)
        x, finer = subdivide(x, finer)
    centre = x[finer].mean(axis=1)
    turn = np.arctan2(centre[:, 1] - middle[1], centre[:, 0] - middle[0])
    above = finer[centre[:, 2] > border_height(rest, sheet, turn, middle)]
    normal = np.cross(x[finer[:, 1]] - x[finer[:, 0]], x[finer[:, 2]] - x[finer[:, 0]])
    outward = np.sign(np.einsum("ij,ij->", normal[:, :2], centre[:, :2] - middle[:2]))
    up = np.cross(rest[sheet[:, 1]] - rest[sheet[:, 0]], rest[sheet[:, 2]] - rest[sheet[:, 0]])
    upward = np.sign(up[:, 2].sum())
    of_wall = np.unique(wall)
    lid = of_wall[rest[of_wall, 2] > rest[of_wall, 2].max() - 1]
    lid = lid[np.arctan2(rest[lid, 1] - middle[1], rest[lid, 0] - middle[0]).argsort()]

    def growth(before, after):
        ends = []
        for points in (before, after):
            for faces in steps:
                points, _ = subdivide(points, faces)
            ends.append(points)
        rings = [before[lid], after[lid]]
        lift = rings[1][:, 2].mean() - rings[0][:, 2].mean()
        top = lift * (section_area(rings[0]) + section_area(rings[1])) / 2
        return (outward * swept(*ends, above).sum() + top - upward * swept(before, after, sheet).sum()) / 1e6

    return growth


def subdivide(points, faces):
    edges = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (inverse.reshape(3, -1) + len(points))
    a, b, c = faces.T
    finer = np.vstack([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return np.vstack([points, points[unique].mean(axis=1)]), finer


def main():
    triangles, frames = read(sys.argv[1])
    rest = frames[0][1]
    breath = [x for time, x in frames if time >= float(sys.argv[2]) - 1e-3]
    sheet = triangles["diaphragm"]
    for at in columns_of(rest[np.unique(sheet)]):
        heights = [top_of_column(x, sheet, at) for x in breath]
        print(f"{heights[0] - min(heights):.4f}", end=" ")
    growth = cavity(triangles, rest)
    volumes = [growth(breath[0], x) for x in breath]
    print(f"{max(volumes) - min(volumes):.5f}")


if __name__ == "__main__":
    main()
