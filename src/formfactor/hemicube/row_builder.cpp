#include "formfactor/hemicube/row_builder.h"

namespace radiosity {

RowBuilder::RowBuilder(const PatchMesh& mesh, const FormFactorOptions& options)
    : mesh_(mesh),
      seed_(options.seed),
      random_turns_(options.random_turns),
      scene_(mesh),
      hidden_backs_(scene_, mesh),
      weights_(options.resolution),
      kernels_(rasterKernels(options.simd)),
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
  hidden_backs_.fromEye(eye, own, hidden);
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

}  // namespace radiosity
