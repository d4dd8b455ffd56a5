// Blocks of form factors made on demand, against the exact matrix and against other blocks.
#include "radiosity/form_factor_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "radiosity/form_factors.h"
#include "radiosity/scene.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

PatchMesh meshOf(const std::string& scene, std::size_t patches) {
  Progress quiet;
  MeshOptions options;
  options.patches = patches;
  return meshScene(loadScene(RADIOSITY_SOURCE_DIR "/data/" + scene), options, quiet).mesh;
}

std::vector<Index> all(const PatchMesh& mesh) {
  std::vector<Index> indices(mesh.size());
  std::iota(indices.begin(), indices.end(), Index(0));
  return indices;
}

std::vector<double> blockOf(const FormFactorKernel& kernel, std::span<const Index> rows,
                            std::span<const Index> columns) {
  std::vector<double> values(rows.size() * columns.size());
  kernel.block(rows, columns, values);
  return values;
}

/// Of the whole matrix, relative, in the area-weighted L2 norm.
double errorAgainstExact(const PatchMesh& mesh, int points) {
  Progress quiet;
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = 1e-5;
  const FormFactors exact = computeFormFactors(mesh, options, quiet);
  const FormFactorKernel kernel(mesh, points, quiet);
  const std::vector<double> values = blockOf(kernel, all(mesh), all(mesh));
  double off = 0;
  double whole = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      const double truth = exact.matrix.at(i, j);
      off += mesh.area[i] * std::pow(values[i * mesh.size() + j] - truth, 2);
      whole += mesh.area[i] * truth * truth;
    }
  }
  return std::sqrt(off / whole);
}

TEST(FormFactorKernel, BlocksApproachTheExactMatrixWithMorePoints) {
  // Two boxes in a closed room, triangles among the patches; Gauss points converge slowly at edges
  // that patches share.
  const PatchMesh mesh = meshOf("cornell-box-closed.obj", 150);
  const double coarse = errorAgainstExact(mesh, 1);
  const double fine = errorAgainstExact(mesh, 4);
  // First order at kinks, where shadows end and patches meet, would be a quarter; 0.0024 and a
  // sixtieth were seen.
  EXPECT_LT(fine, 0.005);
  EXPECT_LT(fine, coarse / 4);
}

TEST(FormFactorKernel, RowsOfAClosedRoomSumToOne) {
  const PatchMesh mesh = meshOf("furnace-cube.obj", 24);
  Progress quiet;
  const FormFactorKernel kernel(mesh, 3, quiet);
  for (const Index i : all(mesh)) {
    const std::vector<double> row = blockOf(kernel, {&i, 1}, all(mesh));
    // Every point sees nothing but the cube: rounding alone.
    EXPECT_NEAR(std::accumulate(row.begin(), row.end(), 0.0), 1, 1e-12) << i;
  }
}

TEST(FormFactorKernel, AnEntryIsTheSameInEveryBlockAndThread) {
  const PatchMesh mesh = meshOf("two-rooms.obj", 100);
  Progress quiet;
  const FormFactorKernel kernel(mesh, 2, quiet);
  const std::vector<Index> patches = all(mesh);
  const std::vector<double> whole = blockOf(kernel, patches, patches);
  const std::vector<Index> columns = {Index(mesh.size() - 1), 7, 7, 0};
  std::vector<std::vector<double>> rows(mesh.size());
  parallelFor(mesh.size(), 1, [&](std::size_t i) {
    rows[i] = blockOf(kernel, std::span(patches).subspan(i, 1), columns);
  });
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      EXPECT_EQ(rows[i][c], whole[i * mesh.size() + columns[c]]) << i << ", " << columns[c];
    }
  }
  EXPECT_TRUE(blockOf(kernel, {}, columns).empty());
}

TEST(FormFactorKernel, RefusesWrongPointsRowsColumnsAndSizes) {
  const PatchMesh mesh = meshOf("furnace-cube.obj", 6);
  Progress quiet;
  const auto message = [](const auto& call) { return test::errorOf(call); };
  EXPECT_NE(message([&] { FormFactorKernel(mesh, 0, quiet); }).find("give 1 to 24"),
            std::string::npos);
  const FormFactorKernel kernel(mesh, 1, quiet);
  const Index beyond = Index(mesh.size());
  const Index first = 0;
  double value = 0;
  const auto asked = [&](const Index& row, const Index& column, std::size_t room) {
    return message([&] { kernel.block({&row, 1}, {&column, 1}, {&value, room}); });
  };
  EXPECT_NE(asked(beyond, first, 1).find("row 6: there are 6 patches"), std::string::npos);
  EXPECT_NE(asked(first, beyond, 1).find("column 6: there are 6 patches"), std::string::npos);
  EXPECT_NE(asked(first, first, 0).find("1 x 1 has room for 0"), std::string::npos);
}

}  // namespace
}  // namespace radiosity
