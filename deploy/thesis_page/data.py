"""Reads what `phrenic` wrote: CSV of probes, OBJ surfaces, Gmsh maps of distances, JSON of studies; and the thesis' numbers."""
import csv
import json
import pathlib


def columns(path):
    """The columns of a CSV file by name."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def surface(path):
    """Vertices [mm], triangles and edges of an OBJ file."""
    vertices, triangles, edges = [], [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            triangles.append(tuple(int(word) - 1 for word in words[1:4]))
        elif words[:1] == ["l"]:
            edges.append(tuple(int(word) - 1 for word in words[1:3]))
    return vertices, triangles, edges


def distances(path):
    """Vertices [mm], triangles, and the distance of each vertex [mm], of a map of `phrenic compare --map x.msh`."""
    lines = pathlib.Path(path).read_text().splitlines()
    nodes = lines.index("$Nodes")
    count = int(lines[nodes + 1])
    vertices = [tuple(map(float, line.split()[1:4])) for line in lines[nodes + 2:nodes + 2 + count]]
    elements = lines.index("$Elements")
    triangles = [tuple(int(word) - 1 for word in line.split()[-3:])
                 for line in lines[elements + 2:lines.index("$EndElements")]]
    data = lines.index("$NodeData")
    end = lines.index("$EndNodeData")
    return vertices, triangles, [float(line.split()[1]) for line in lines[end - count:end] if data < end]


def study(path):
    return json.loads(pathlib.Path(path).read_text())["cost"]


# Seconds of the five trials: 100,000 iterations of the cubes, 100 of the thoraces.
THESIS = {
    "5.10": {"Tensegrity": [4.174, 4.287, 4.069, 4.599, 4.198], "Tensile": [3.155, 3.337, 3.602, 3.244, 3.387]},
    "5.12": {"Full": [15.472, 15.39, 15.448, 15.654, 15.435],
             "No attachment": [12.174, 12.098, 12.126, 12.565, 12.534],
             "No rib kinematics": [12.256, 12.097, 12.043, 12.129, 12.261]},
    "5.14": {"High": [12.174, 12.098, 12.126, 12.565, 12.534], "Medium": [9.543, 9.63, 9.552, 9.725, 9.603],
             "Low": [7.851, 7.735, 7.907, 7.842, 7.763]},
    "5.16": {"High": [15.931, 15.386, 15.778, 15.659, 15.748], "Medium": [8.597, 8.313, 8.077, 8.501, 8.018],
             "Low": [5.167, 5.092, 5.217, 5.081, 5.225]},
    "5.19": {"High": [11.542, 11.831, 11.732, 11.657, 11.672], "Medium": [9.703, 9.206, 9.144, 9.043, 9.691],
             "Low": [7.832, 7.645, 7.451, 7.621, 7.705]},
    "5.21": {"High": [14.522, 14.865, 14.469, 14.629, 14.614], "Medium": [7.839, 7.929, 7.92, 8.016, 7.992],
             "Low": [5.063, 5.047, 4.983, 5.087, 5.214]},
}
VERTICES = {"perfect": {"High": 20909, "Medium": 16023, "Low": 12047},
            "patient": {"High": 20740, "Medium": 10162, "Low": 5185}}
# Iterations per second of figure 5.24: with links, without, rib kinematics only, diaphragm only.
RATES = {"High": [8.13, 8.56, 8.24, 9.68], "Medium": [10.41, 10.69, 10.93, 11.76], "Low": [12.79, 13.07, 13.27, 14.70]}
PATIENT_RATES = {"High": [6.37, 6.84], "Medium": [12.05, 12.60], "Low": [19.39, 19.69]}
# Figure 5.27: links, and their cost [%].
LINKS = {"High": (1663, 5.24), "Medium": (1022, 2.71), "Low": (602, 2.21)}
PATIENT_LINKS = {"High": (4858, 3.65), "Medium": (648, 2.71), "Low": (940, 3.85)}
