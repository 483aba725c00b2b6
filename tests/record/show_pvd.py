# Draws the first frame of a .pvd and the one that moved most, coloured by displacement, in VTK:
# xvfb-run -a /usr/bin/python3 tests/record/show_pvd.py motion.pvd picture.png
import os
import sys
import xml.etree.ElementTree as xml

import vtk


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    data.GetPointData().SetActiveScalars("displacement [mm]")
    return data


def moved(data):
    return data.GetPointData().GetArray("displacement [mm]").GetRange(-1)[1]


def actor_of(data, most):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    table = mapper.GetLookupTable()
    table.SetVectorModeToMagnitude()
    table.SetHueRange(0.62, 0.0)
    mapper.SetScalarRange(0, most)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("displacement [mm]")
    table.Build()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor, mapper


def caption(text):
    words = vtk.vtkTextActor()
    words.SetInput(text)
    words.GetTextProperty().SetFontSize(16)
    words.GetTextProperty().SetColor(0.1, 0.1, 0.1)
    words.SetPosition(12, 10)
    return words


def main(pvd, png):
    folder = os.path.dirname(os.path.abspath(pvd))
    steps = [(float(s.get("timestep")), read(os.path.join(folder, s.get("file"))))
             for s in xml.parse(pvd).getroot().iter("DataSet")]
    last = max(steps, key=lambda step: moved(step[1]))
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(900, 380)
    for place, (time, data) in enumerate((steps[0], last)):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(place / 2, 0, (place + 1) / 2, 1)
        renderer.SetBackground(1, 1, 1)
        actor, mapper = actor_of(data, moved(last[1]))
        renderer.AddActor(actor)
        renderer.AddActor2D(caption("t = %.2f s" % time))
        if place == 1:
            bar = vtk.vtkScalarBarActor()
            bar.SetLookupTable(mapper.GetLookupTable())
            bar.SetTitle("mm")
            bar.SetNumberOfLabels(3)
            bar.SetWidth(0.1)
            bar.SetHeight(0.5)
            bar.SetPosition(0.88, 0.3)
            for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
                text.SetColor(0.1, 0.1, 0.1)
            renderer.AddActor2D(bar)
        camera = renderer.GetActiveCamera()
        camera.SetPosition(0.35, -1, 0.3)  # in LPS: from before, and a little above
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(0, 0, 1)
        renderer.ResetCamera()
        camera.Zoom(1.35)
        window.AddRenderer(renderer)
    window.Render()
    picture = vtk.vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(png)
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()


main(*sys.argv[1:])
