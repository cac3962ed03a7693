"""Writes one small mesh in the ways that VTK can store it: `pip install vtk`, then run this here.

The mesh is a tetrahedron with uneven corners, split into four tetrahedra and an octahedron, and one
boundary triangle. The points are in double precision. Written with VTK 9.7.
"""

from itertools import combinations

import vtk

CORNERS = [(0.1, 0.2, -0.3), (1.7, 0.0, 0.1), (-0.2, 2.3, 0.4), (0.3, 0.1, 1.9)]
FACES = [(0, 2, 1), (0, 1, 5), (0, 4, 2), (0, 5, 4), (3, 1, 2), (3, 5, 1), (3, 2, 4), (3, 4, 5)]
SAMPLES = [  # name, data mode, compressed, base64, header bits, little-endian
    ("ascii", 0, False, False, 32, True),
    ("inline-plain-32-little", 1, False, True, 32, True),
    ("inline-zlib-64-big", 1, True, True, 64, False),
    ("raw-plain-64-little", 2, False, False, 64, True),
    ("raw-zlib-32-big", 2, True, False, 32, False),
    ("base64-plain-32-big", 2, False, True, 32, False),
    ("base64-zlib-64-little", 2, True, True, 64, True),
]


def id_list(indices):
    ids = vtk.vtkIdList()
    for index in indices:
        ids.InsertNextId(index)
    return ids


points = vtk.vtkPoints()
points.SetDataTypeToDouble()
for corner in CORNERS:
    points.InsertNextPoint(corner)
middle = {}
for a, b in combinations(range(4), 2):
    middle[a, b] = points.InsertNextPoint([(p + q) / 2 for p, q in zip(CORNERS[a], CORNERS[b])])

grid = vtk.vtkUnstructuredGrid()
grid.SetPoints(points)
for i in range(4):
    corners = [i if k == i else middle[min(i, k), max(i, k)] for k in range(4)]
    grid.InsertNextCell(vtk.VTK_TETRA, id_list(corners))
octahedron = [middle[pair] for pair in [(0, 1), (0, 2), (0, 3), (2, 3), (1, 3), (1, 2)]]
stream = [len(FACES)]
for face in FACES:
    stream += [3] + [octahedron[corner] for corner in face]
grid.InsertNextCell(vtk.VTK_POLYHEDRON, id_list(stream))
grid.InsertNextCell(vtk.VTK_TRIANGLE, id_list([0, middle[0, 2], middle[0, 1]]))

for name, mode, compressed, base64, header, little in SAMPLES:
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(f"{name}.vtu")
    writer.SetDataMode(mode)
    if compressed:
        writer.SetCompressorTypeToZLib()
    else:
        writer.SetCompressorTypeToNone()
    writer.SetEncodeAppendedData(base64)
    writer.SetHeaderTypeToUInt32() if header == 32 else writer.SetHeaderTypeToUInt64()
    writer.SetByteOrderToLittleEndian() if little else writer.SetByteOrderToBigEndian()
    writer.Write()

for name, binary, version in [
    ("legacy-42-binary", True, 42),
    ("legacy-51-binary", True, 51),
    ("legacy-51-ascii", False, 51),
]:
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(f"{name}.vtk")
    writer.SetFileVersion(version)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    writer.Write()
