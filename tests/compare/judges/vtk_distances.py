"""Measures distances from random points of surface A to surface B with VTK: mean, RMS, 95th percentile, maximum.

Usage: vtk_distances.py A.obj B.obj; prints the four numbers in the files' unit.
"""

import sys

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

SAMPLES = 100_000


def read(path):
    reader = vtk.vtkOBJReader()
    reader.SetFileName(path)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(reader.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def random_points(surface):
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    corners = points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = numpy.linalg.norm(numpy.cross(ab, ac), axis=1)
    generator = numpy.random.default_rng(1)
    triangle = generator.choice(len(area), SAMPLES, p=area / area.sum())
    u, v = generator.random((2, SAMPLES, 1))
    outside = u + v > 1
    u, v = numpy.where(outside, 1 - u, u), numpy.where(outside, 1 - v, v)
    return a[triangle] + u * ab[triangle] + v * ac[triangle]


def distances(points, surface):
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    nearest, cell = [0.0, 0.0, 0.0], vtk.vtkGenericCell()
    cell_id, sub_id, squared = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    found = numpy.empty(len(points))
    for i, point in enumerate(points):
        locator.FindClosestPoint(point, nearest, cell, cell_id, sub_id, squared)
        found[i] = squared.get()
    return numpy.sqrt(found)


def main():
    d = distances(random_points(read(sys.argv[1])), read(sys.argv[2]))
    print(d.mean(), numpy.sqrt((d * d).mean()), numpy.percentile(d, 95), d.max())


if __name__ == "__main__":
    main()
