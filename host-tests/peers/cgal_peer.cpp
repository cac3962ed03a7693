// Refines an .off mesh with CGAL in double precision: SCHEME LEVELS IN OUT. An OUT that ends with .off
// holds the refined mesh, any other its vertices.
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/OFF.h>
#include <CGAL/subdivision_method_3.h>
#include <fstream>
#include <iostream>
#include <string>

int main(int count, char **words) {
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  if (count != 5) return 2;
  const std::string scheme = words[1];
  const int levels = std::stoi(words[2]);
  Mesh mesh;
  if (!CGAL::IO::read_OFF(words[3], mesh)) return 3;
  namespace method = CGAL::Subdivision_method_3;
  const auto steps = CGAL::parameters::number_of_iterations(levels);
  if (scheme == "loop") method::Loop_subdivision(mesh, steps);
  else if (scheme == "catmull-clark") method::CatmullClark_subdivision(mesh, steps);
  else if (scheme == "doo-sabin") method::DooSabin_subdivision(mesh, steps);
  else if (scheme == "sqrt3") method::Sqrt3_subdivision(mesh, steps);
  else return 4;
  const std::string name = words[4];
  std::ofstream out(name);
  out.precision(17);
  if (name.ends_with(".off")) return CGAL::IO::write_OFF(out, mesh) ? 0 : 5;
  for (auto vertex : mesh.vertices()) out << mesh.point(vertex) << "\n";
  return out ? 0 : 5;
}
