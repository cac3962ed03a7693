// Measures weighted sums of control points on this machine, one thread: OpenSubdiv's evaluation of
// stencils where its headers are installed, and compressed sparse rows in floating point. Takes the file
// of rows that `cargo xtask bench` writes (see host-tests/src/performance/input.rs), and prints a line
// for each: a name, an equals sign, rows a second. The best of many runs counts.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>
#if !defined(WITHOUT_OPENSUBDIV) && __has_include(<opensubdiv/osd/cpuEvaluator.h>)
#include <opensubdiv/osd/cpuEvaluator.h>
#define HAS_OPENSUBDIV 1
#endif

namespace {

template <class T> std::vector<T> take(const char *&bytes, size_t count) {
  const T *first = reinterpret_cast<const T *>(bytes);
  bytes += count * sizeof(T);
  return std::vector<T>(first, first + count);
}

struct Rows {
  std::vector<int> starts, sizes, indices;
  std::vector<float> weights;
};

void csr(const Rows &rows, const float *__restrict pose, float *__restrict out) {
  for (size_t row = 0; row < rows.sizes.size(); ++row) {
    float x = 0, y = 0, z = 0;
    const int start = rows.starts[row], end = start + rows.sizes[row];
    for (int tap = start; tap < end; ++tap) {
      const float weight = rows.weights[tap], *point = pose + 3 * rows.indices[tap];
      x += weight * point[0];
      y += weight * point[1];
      z += weight * point[2];
    }
    out[3 * row] = x;
    out[3 * row + 1] = y;
    out[3 * row + 2] = z;
  }
}

template <class Work> void measure(const char *name, size_t rows, Work work) {
  using Clock = std::chrono::steady_clock;
  double best = 1e9;
  for (int run = 0; run < 300; ++run) {
    const auto start = Clock::now();
    work();
    const std::chrono::duration<double> time = Clock::now() - start;
    if (time.count() < best) best = time.count();
  }
  std::printf("%s=%.0f\n", name, rows / best);
}

}  // namespace

int main(int count, char **words) {
  if (count != 2) return 2;
  std::ifstream file(words[1], std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.size() < 5 * sizeof(uint32_t)) return 2;
  const char *at = bytes.data();
  const auto counts = take<uint32_t>(at, 5);
  const size_t row_count = counts[0], taps = counts[1];
  const auto starts = take<uint32_t>(at, row_count + 1);
  Rows rows;
  rows.weights = take<float>(at, taps);
  at += counts[3] * sizeof(float) + counts[2] * 2 * sizeof(uint16_t);
  const auto indices = take<uint16_t>(at, taps);
  rows.indices.assign(indices.begin(), indices.end());
  int points = 0;
  for (const int index : rows.indices) points = index >= points ? index + 1 : points;
  for (size_t row = 0; row < row_count; ++row) {
    rows.starts.push_back(starts[row]);
    rows.sizes.push_back(starts[row + 1] - starts[row]);
  }
  std::vector<float> pose(3 * points), out(3 * row_count);
  for (size_t i = 0; i < pose.size(); ++i) pose[i] = 1.0f / (1 + i);
  volatile float seen = 0;
#if HAS_OPENSUBDIV
  using namespace OpenSubdiv::Osd;
  const BufferDescriptor layout(0, 3, 3);
  measure("opensubdiv", row_count, [&] {
    CpuEvaluator::EvalStencils(pose.data(), layout, out.data(), layout, rows.sizes.data(),
                               rows.starts.data(), rows.indices.data(), rows.weights.data(), 0,
                               static_cast<int>(row_count));
    seen = out[row_count];
  });
#endif
  measure("float csr in C++", row_count, [&] {
    csr(rows, pose.data(), out.data());
    seen = out[row_count];
  });
  return seen == seen ? 0 : 1;
}
