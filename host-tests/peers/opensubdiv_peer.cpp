// Refines an .off mesh with OpenSubdiv in double precision: SCHEME LEVELS IN OUT [FEATURES [limit]], where
// FEATURES (or -) has a line "crease A B" or "corner A" each, vertices counted from 0. With "limit" the vertices
// go to the limit and each is followed by the limit's normal: zeros where creases meet it or OpenSubdiv's masks
// belong to other rules beside a crease (rims with other than the regular number of faces).
#include <cmath>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

using namespace OpenSubdiv;

struct Vertex {
  double at[3] = {0, 0, 0};
  void Clear(void * = nullptr) { at[0] = at[1] = at[2] = 0; }
  void AddWithWeight(Vertex const &other, double weight) {
    for (int i = 0; i < 3; ++i) at[i] += weight * other.at[i];
  }
};

int main(int count, char **words) {
  if (count < 5 || count > 7) return 2;
  const bool to_limit = count == 7;
  const std::string scheme = words[1];
  const int levels = std::stoi(words[2]);
  std::ifstream in(words[3]);
  std::string header;
  int vertices = 0, faces = 0, edges = 0;
  in >> header >> vertices >> faces >> edges;
  std::vector<Vertex> points(vertices);
  for (auto &point : points) in >> point.at[0] >> point.at[1] >> point.at[2];
  std::vector<int> sizes(faces), corners;
  for (int &size : sizes) {
    in >> size;
    for (int i = 0; i < size; ++i) {
      int vertex;
      in >> vertex;
      corners.push_back(vertex);
    }
  }
  if (!in) return 3;
  std::vector<int> crease_pairs, corner_vertices;
  if (count >= 6 && std::string(words[5]) != "-") {
    std::ifstream features(words[5]);
    std::string kind;
    while (features >> kind) {
      int a, b;
      features >> a;
      if (kind == "corner") {
        corner_vertices.push_back(a);
      } else {
        features >> b;
        crease_pairs.push_back(a);
        crease_pairs.push_back(b);
      }
    }
  }
  const float infinite = Sdc::Crease::SHARPNESS_INFINITE;
  std::vector<float> crease_weights(crease_pairs.size() / 2, infinite);
  std::vector<float> corner_weights(corner_vertices.size(), infinite);
  Far::TopologyDescriptor mesh;
  mesh.numVertices = vertices;
  mesh.numFaces = faces;
  mesh.numVertsPerFace = sizes.data();
  mesh.vertIndicesPerFace = corners.data();
  mesh.numCreases = int(crease_weights.size());
  mesh.creaseVertexIndexPairs = crease_pairs.data();
  mesh.creaseWeights = crease_weights.data();
  mesh.numCorners = int(corner_weights.size());
  mesh.cornerVertexIndices = corner_vertices.data();
  mesh.cornerWeights = corner_weights.data();

  const auto type = scheme == "loop" ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(mesh, Factory::Options(type, options)));
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = to_limit;
  refiner->RefineUniform(uniform);
  Far::PrimvarRefinerReal<double> primvar(*refiner);
  for (int level = 1; level <= levels; ++level) {
    std::vector<Vertex> next(refiner->GetLevel(level).GetNumVertices());
    auto *to = next.data();
    primvar.Interpolate(level, points.data(), to);
    points.swap(next);
  }
  std::ofstream out(words[4]);
  out.precision(17);
  if (to_limit) {
    std::vector<Vertex> at(points.size()), one(points.size()), other(points.size());
    auto *limits = at.data(), *ones = one.data(), *others = other.data();
    primvar.Limit(points.data(), limits, ones, others);
    const Far::TopologyLevel last = refiner->GetLevel(levels);
    for (int v = 0; v < int(points.size()); ++v) {
      double a[3], b[3];
      for (int i = 0; i < 3; ++i) a[i] = one[v].at[i], b[i] = other[v].at[i];
      double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      int sharp = 0;
      const auto around = last.GetVertexEdges(v);
      for (int e = 0; e < around.size(); ++e) {
        sharp += last.GetEdgeSharpness(around[e]) > 0 && !last.IsEdgeBoundary(around[e]);
      }
      const int regular = scheme == "loop" ? 3 : 2;
      const bool corner = last.GetVertexSharpness(v) > 0;
      const bool usable = last.IsVertexBoundary(v) ? last.GetVertexFaces(v).size() == regular : true;
      const double keep = sharp == 0 && !corner && usable && length > 0 ? 1 / length : 0;
      for (double x : at[v].at) out << x << " ";
      for (double x : n) out << x * keep << " ";
      out << "\n";
    }
    return out ? 0 : 5;
  }
  for (auto const &p : points) out << p.at[0] << " " << p.at[1] << " " << p.at[2] << "\n";
  return out ? 0 : 5;
}
