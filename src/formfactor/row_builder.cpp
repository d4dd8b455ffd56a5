#include "formfactor/row_builder.h"

#include <tbb/global_control.h>

#include <algorithm>

namespace radiosity {

RowBuilder::RowBuilder(const PatchMesh& mesh, const FormFactorOptions& options)
    : mesh_(mesh),
      seed_(options.seed),
      random_turns_(options.random_turns),
      scene_(mesh),
      hidden_backs_(scene_),
      weights_(options.resolution),
      kernels_(options.simd ? simdKernels() : scalarKernels()),
      polygon_place_(mesh.polygons.size()) {
  for (Index p = 0; p < scene_.polygons.size(); ++p) polygon_place_[scene_.polygons[p].source] = p;
}

bool RowBuilder::isEmpty(std::size_t patch) const {
  return !(mesh_.area[patch] > 0) || mesh_.polygon[patch] == kNone;
}

const HemicubeView& RowBuilder::look(std::size_t patch, Hemicube& hemicube,
                                     std::vector<std::uint8_t>& hidden) const {
  const double angle = random_turns_ ? turnAngle(mesh_, patch, seed_) : 0.0;
  return lookFrom(mesh_.centroid[patch], mesh_.normal[patch], angle, mesh_.polygon[patch], hemicube,
                  hidden);
}

const HemicubeView& RowBuilder::lookFrom(const Vec3& eye, const Vec3& normal, double angle,
                                         Index own, Hemicube& hemicube,
                                         std::vector<std::uint8_t>& hidden,
                                         RunVisitor* runs) const {
  const Index place = own == kNone ? kNone : polygon_place_[own];
  const Vec3 scaled = eye * scene_.scale;
  hidden_backs_.fromEye(scaled, place, hidden);
  return hemicube.look(eyeFrame(scaled, normal, angle), place, hidden.data(), runs);
}

void PackedRow::pack(const HemicubeView& view, std::size_t patches) {
  columns.clear();
  values.clear();
  for (std::size_t j = 0; j < patches; ++j) {
    if (view.items[j] > 0) {
      columns.push_back(Index(j));
      values.push_back(view.items[j]);
    }
  }
}

std::size_t estimateBytes(const PatchMesh& mesh, const FormFactorOptions& options,
                          const RowBuilder& rows) {
  constexpr std::size_t kSamples = 32;
  const std::size_t n = mesh.size();
  Hemicube hemicube = rows.makeHemicube();
  std::vector<std::uint8_t> hidden;
  PackedRow row;
  std::size_t entries = 0;
  const std::size_t samples = std::min(n, kSamples);
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t patch = (2 * k + 1) * n / (2 * samples);
    if (rows.isEmpty(patch)) continue;
    row.pack(rows.look(patch, hemicube, hidden), n);
    entries += row.columns.size();
  }
  const double per_row = samples == 0 ? 0.0 : double(entries) / double(samples);
  const std::size_t matrix = ExchangeMatrix::estimateBytes(n, per_row, options.storedPrecision());
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  constexpr std::size_t kAccounts = 4 * sizeof(double);  // fronts, backs, sky, area
  // Merging both estimates makes a second matrix beside the first.
  return (options.symmetrize ? 2 : 1) * matrix + n * kAccounts + rows.sharedBytes() +
         threads * hemicube.bytes();
}

}  // namespace radiosity
