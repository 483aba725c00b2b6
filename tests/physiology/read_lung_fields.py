#!/usr/bin/python3
# read_lung_fields.py VTI NIFTI VTU: reads a lung field with VTK and with nibabel; fails unless all hold the same vectors
# at the same points in LPS, of a quiet breath: down at the base, volume gained.
import sys

import nibabel
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

reader = vtk.vtkXMLImageDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
image = reader.GetOutput()
size = image.GetDimensions()
arrays = {name: vtk_to_numpy(image.GetPointData().GetArray(name)) for name in ("displacement", "ventilation", "lung")}
vectors = arrays["displacement"].reshape(size[::-1] + (3,)).transpose(2, 1, 0, 3)

nifti = nibabel.load(sys.argv[2])
assert nifti.header["intent_code"] == 1007, nifti.header["intent_code"]
assert nifti.shape == size + (1, 3), nifti.shape
assert np.allclose(np.asarray(nifti.dataobj)[:, :, :, 0, :], vectors, atol=1e-4)
lps = np.diag([-1, -1, 1, 1]) @ nifti.affine
assert np.allclose(lps[:3, 3], image.GetOrigin(), atol=1e-3), lps
assert np.allclose(np.diag(lps)[:3], image.GetSpacing()), lps

inside = arrays["lung"] > 0
points = np.array([image.GetPoint(i) for i in np.flatnonzero(inside)])
z = points[:, 2]
down = -arrays["displacement"][inside, 2]
assert set(arrays["lung"]) == {0, 1, 2}
assert np.all(points[arrays["lung"][inside] == 1, 0] < 0), "the right lung lies at negative x"
assert down[z < np.quantile(z, 0.2)].mean() > 5 > down[z > np.quantile(z, 0.9)].mean()
assert arrays["ventilation"][inside].mean() > 0.03
assert np.all(arrays["displacement"][~inside] == 0)

# The bricks have the same field: probed at the image's points, where both are inside a lung.
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[3])
reader.Update()
bricks = reader.GetOutput()
assert bricks.GetNumberOfCells() > 200 and bricks.GetCellType(0) == vtk.VTK_VOXEL
part = vtk_to_numpy(bricks.GetCellData().GetArray("inside"))
assert part.min() >= 0 and part.max() == 1
probe = vtk.vtkProbeFilter()
probe.SetInputData(image)
probe.SetSourceData(bricks)
probe.Update()
probed = probe.GetOutput().GetPointData()
valid = vtk_to_numpy(probed.GetArray("vtkValidPointMask"))[inside] == 1
# Where the lattices of both lungs overlap the probe may take either.
same = np.abs(vtk_to_numpy(probed.GetArray("displacement"))[inside] - arrays["displacement"][inside]).max(axis=1) < 1e-3
assert valid.mean() > 0.99, valid.mean()
assert same[valid].mean() > 0.97, same[valid].mean()
