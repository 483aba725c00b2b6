# Opens each file format that Phrenic writes in another program and makes one picture of the results:
# xvfb-run -a /usr/bin/python3 tests/record/show_formats.py build/phrenic out.png
# Needs python3-vtk9, gmsh, gnuplot-nox, imagemagick, xvfb.
import os
import subprocess
import sys
import tempfile

import vtk

SIZE = 300
MOST = 25  # [mm]


def run(*words, **options):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, **options)


def look_from_the_front(camera, up):
    # From the front and slightly above: in LPS, and in glTF with +y up and the chest towards +z.
    camera.SetPosition(*((0.35, -1, 0.3) if up == "z" else (0.35, 0.3, 1)))
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(*((0, 0, 1) if up == "z" else (0, 1, 0)))


def picture(renderer, png, up="z"):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(SIZE, SIZE)
    renderer.SetBackground(1, 1, 1)
    window.AddRenderer(renderer)
    look_from_the_front(renderer.GetActiveCamera(), up)
    renderer.ResetCamera()
    renderer.GetActiveCamera().Zoom(1.3)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(png)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def renderer_of(port, color=None):
    # Without a color: by displacement.
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(port)
    mapper.SetScalarVisibility(color is None)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("displacement [mm]")
    mapper.SetScalarRange(0, MOST)
    mapper.GetLookupTable().SetVectorModeToMagnitude()
    mapper.GetLookupTable().SetHueRange(0.62, 0.0)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*(color or (1, 1, 1)))
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    return renderer


def surface(reader, file, png, color=(0.72, 0.3, 0.25)):
    reader.SetFileName(file)
    picture(renderer_of(reader.GetOutputPort(), color), png)


def gltf(file, png, seconds):
    reader = vtk.vtkGLTFReader()
    reader.SetFileName(file)
    reader.ApplyDeformationsToGeometryOn()
    reader.UpdateInformation()
    reader.EnableAnimation(0)
    reader.UpdateInformation()
    reader.UpdateTimeStep(seconds)
    geometry = vtk.vtkCompositeDataGeometryFilter()
    geometry.SetInputConnection(reader.GetOutputPort())
    picture(renderer_of(geometry.GetOutputPort(), (0.85, 0.55, 0.3)), png, up="y")


def gmsh(file, png, step):
    script = png + ".geo"
    with open(script, "w") as out:
        out.write(f'Merge "{file}"; Mesh.SurfaceEdges = 0; View.VectorType = 5; View.TimeStep = {step};\n'
                  "General.Trackball = 0; General.RotationX = -75; General.RotationZ = 20; General.SmallAxes = 0;\n"
                  "View.ShowScale = 0; General.GraphicsWidth = 1000; General.GraphicsHeight = 1000;\n"
                  f'Draw; Print "{png}"; Exit;\n')
    run("gmsh", script, timeout=120)
    run("convert", png, "-trim", png)


def curves(file, png):
    run("gnuplot", "-e", f"set terminal pngcairo size {SIZE},{SIZE} font 'sans,9'; set output '{png}';"
        "set datafile separator ','; set xlabel 'time [s]'; set ylabel 'height [mm]';"
        f"plot '{file}' every ::1 using 1:4 with linespoints title 'right summit',"
        f" '' every ::1 using 1:7 with linespoints title 'left dome'")


def paths(file, png):
    # The format in one line of awk: the first row of each vertex is a position, the others are changes.
    program = 'NR==1 {n = $4; next} {k = (NR - 2) % n; z = k ? z + $3 : $3; v = int((NR - 2) / n)} ' \
          'v % 400 == 0 {if (!k) print ""; print k, z}'
    with open(png + ".txt", "w") as table:
        subprocess.run(["awk", program, file], check=True, stdout=table)
    run("gnuplot", "-e", f"set terminal pngcairo size {SIZE},{SIZE} font 'sans,9'; set output '{png}';"
        "set xlabel 'row'; set ylabel 'z [mm]'; set key off;"
        f"plot '{png}.txt' with lines lc rgb '#b4473a'")


def main(phrenic, out):
    os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        for ending in ("msh", "pvd", "glb", "csv", "depl"):
            run(phrenic, "run", "thorax", "--seconds", 4, "--fps", 8, "--export", at("motion." + ending),
                stderr=subprocess.DEVNULL)
        for ending in ("obj", "stl", "ply", "vtk"):
            run(phrenic, "run", "thorax", "--seconds", 1.6, "--export", at("now." + ending), stderr=subprocess.DEVNULL)
        middle = 13  # of 33 frames: the end of inspiration
        gmsh(at("motion.msh"), at("1.png"), middle)
        surface(vtk.vtkXMLPolyDataReader(), at(f"motion/motion_{middle:06d}.vtp"), at("2.png"), color=None)
        gltf(at("motion.glb"), at("3.png"), middle / 8)
        curves(at("motion.csv"), at("4.png"))
        paths(at("motion.depl"), at("5.png"))
        readers = (vtk.vtkOBJReader, vtk.vtkSTLReader, vtk.vtkPLYReader, vtk.vtkPolyDataReader)
        for number, (ending, reader) in enumerate(zip(("obj", "stl", "ply", "vtk"), readers), 6):
            surface(reader(), at("now." + ending), at(f"{number}.png"))
        labels = (".msh in Gmsh", ".pvd, .vtp in VTK", ".glb in VTK", ".csv in gnuplot", ".depl in awk and gnuplot",
                  ".obj in VTK", ".stl in VTK", ".ply in VTK", ".vtk in VTK")
        words = ["montage", "-font", "DejaVu-Sans", "-pointsize", "13", "-tile", "5x", "-geometry", "+6+4", "-gravity", "center"]
        for number, label in enumerate(labels, 1):
            words += ["-label", label, "(", at(f"{number}.png"), "-resize", f"{SIZE}x{SIZE}", "-gravity", "center",
                      "-extent", f"{SIZE}x{SIZE}", ")"]
        run(*words, "-quality", "88", out)


main(*sys.argv[1:])
