"""Prints boundary edges, non-manifold edges, components, area [mm^2] and volume [mm^3] of an OBJ in millimetres."""

import sys

import vtk


def edges(surface, boundary):
    found = vtk.vtkFeatureEdges()
    found.SetInputData(surface)
    found.FeatureEdgesOff()
    found.ManifoldEdgesOff()
    found.SetBoundaryEdges(boundary)
    found.SetNonManifoldEdges(not boundary)
    found.Update()
    return found.GetOutput().GetNumberOfCells()


reader = vtk.vtkOBJReader()
reader.SetFileName(sys.argv[1])
reader.Update()
surface = reader.GetOutput()
parts = vtk.vtkPolyDataConnectivityFilter()
parts.SetInputData(surface)
parts.SetExtractionModeToAllRegions()
parts.Update()
mass = vtk.vtkMassProperties()
mass.SetInputData(surface)
print(edges(surface, True), edges(surface, False), parts.GetNumberOfExtractedRegions(), mass.GetSurfaceArea(), mass.GetVolume())
