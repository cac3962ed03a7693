// Refines an .off mesh with OpenMesh in double precision: SCHEME LEVELS IN OUT.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/Sqrt3T.hh>
#include <fstream>
#include <string>

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

int main(int count, char **words) {
  if (count != 5) return 2;
  const std::string scheme = words[1];
  const int levels = std::stoi(words[2]);
  Mesh mesh;
  // Read by hand: OpenMesh's reader passes through single precision.
  std::ifstream in(words[3]);
  std::string header;
  int vertices = 0, faces = 0, edges = 0;
  in >> header >> vertices >> faces >> edges;
  std::vector<Mesh::VertexHandle> handles;
  for (int i = 0; i < vertices; ++i) {
    double x, y, z;
    in >> x >> y >> z;
    handles.push_back(mesh.add_vertex(Mesh::Point(x, y, z)));
  }
  for (int i = 0; i < faces; ++i) {
    int corners, a, b, c;
    in >> corners >> a >> b >> c;
    mesh.add_face(handles[a], handles[b], handles[c]);
  }
  if (!in) return 3;
  if (scheme == "loop") {
    OpenMesh::Subdivider::Uniform::LoopT<Mesh, double> loop;
    loop.attach(mesh);
    loop(levels);
    loop.detach();
  } else if (scheme == "sqrt3") {
    OpenMesh::Subdivider::Uniform::Sqrt3T<Mesh, double> sqrt3;
    sqrt3.attach(mesh);
    sqrt3(levels);
    sqrt3.detach();
  } else {
    return 4;
  }
  std::ofstream out(words[4]);
  out.precision(17);
  for (auto vertex : mesh.vertices()) out << mesh.point(vertex) << "\n";
  return out ? 0 : 5;
}
