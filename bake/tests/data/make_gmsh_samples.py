"""Writes two tetrahedra on a common face with Gmsh, in every format of its own that is read.

pip install gmsh; then run this script in its folder. Gmsh 4.15.2 wrote the files that are here.
"""

import gmsh

POINTS = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0.5, 0.25, 2), (0.5, 0.5, -2)]

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
add = gmsh.model.addDiscreteEntity
vertex = add(0, 1)
curve = add(1, 1)
surface = add(2, 1)
volumes = [add(3, 1), add(3, 2)]
coordinates = [coordinate for point in POINTS for coordinate in point]
gmsh.model.mesh.addNodes(3, 1, [1, 2, 3, 4, 5], coordinates)
gmsh.model.mesh.addElementsByType(vertex, 15, [1], [4])
gmsh.model.mesh.addElementsByType(curve, 1, [2], [2, 1])
gmsh.model.mesh.addElementsByType(surface, 2, [3], [1, 2, 3])
gmsh.model.mesh.addElementsByType(volumes[0], 4, [4], [1, 2, 3, 4])
gmsh.model.mesh.addElementsByType(volumes[1], 4, [5], [1, 3, 2, 5])
gmsh.model.addPhysicalGroup(0, [vertex], 7, "Corner top")
gmsh.model.addPhysicalGroup(1, [curve], 8, "crease rim")
gmsh.model.addPhysicalGroup(2, [surface], 9, "crease between")
gmsh.model.addPhysicalGroup(3, [volumes[0]], 1, "upper")
gmsh.model.addPhysicalGroup(3, [volumes[1]], 2, "lower")

for name, version, binary in [
    ("gmsh-22-ascii.msh", 2.2, 0),
    ("gmsh-22-binary.msh", 2.2, 1),
    ("gmsh-41-ascii.msh", 4.1, 0),
    ("gmsh-41-binary.msh", 4.1, 1),
    ("gmsh-ascii.vtk", 4.1, 0),
    ("gmsh-binary.vtk", 4.1, 1),
    ("gmsh.mesh", 4.1, 0),
]:
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    # Physical groups as references of Medit's elements.
    gmsh.option.setNumber("Mesh.SaveElementTagType", 2)
    gmsh.write(name)
gmsh.finalize()
