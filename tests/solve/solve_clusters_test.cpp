// Light between clusters of patches against light between the patches themselves: the same form
// factors, summed over clusters, must give every surface the same power.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "formfactor/cluster_factors.h"
#include "radiosity/solve.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

/// A body of revolution about the vertical axis at `centre`: `profile` from bottom to top, radius
/// and height; fronts outward.
void turnedBody(SceneBuilder& builder, Index surface, const Vec3& centre,
                const std::vector<Vec2>& profile, std::size_t around, bool outward = true) {
  const auto point = [&](const Vec2& p, std::size_t k) {
    const double a = 2 * std::numbers::pi * double(k % around) / double(around);
    return centre + Vec3(p.x * std::cos(a), p.x * std::sin(a), p.y);
  };
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (std::size_t k = 0; k < around; ++k) {
      std::vector<Vec3> face{point(profile[ring], k), point(profile[ring], k + 1),
                             point(profile[ring + 1], k + 1), point(profile[ring + 1], k)};
      if (profile[ring].x == 0) face.erase(face.begin());
      if (profile[ring + 1].x == 0) face.pop_back();
      if (!outward) std::reverse(face.begin(), face.end());
      builder.face(surface, face);
    }
  }
}

std::vector<Vec2> arc(double radius, double from, double to, std::size_t steps) {
  std::vector<Vec2> out;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double a = std::numbers::pi * (from + (to - from) * double(k) / double(steps));
    const double r = radius * std::cos(a);
    out.emplace_back(std::abs(r) < 1e-9 * radius ? 0.0 : r, radius * std::sin(a));
  }
  return out;
}

void room(SceneBuilder& builder, double width, double depth, double height) {
  const auto wall = [&](const char* name, double reflectance, const std::vector<Vec3>& corners) {
    builder.face(builder.surface(name, reflectance), corners);
  };
  wall("floor", 0.3, {{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}});
  wall("ceiling", 0.8, {{0, 0, height}, {0, depth, height}, {width, depth, height}, {width, 0, height}});
  wall("left", 0.6, {{0, 0, 0}, {0, depth, 0}, {0, depth, height}, {0, 0, height}});
  wall("right", 0.6, {{width, 0, 0}, {width, 0, height}, {width, depth, height}, {width, depth, 0}});
  wall("near", 0.5, {{0, 0, 0}, {0, 0, height}, {width, 0, height}, {width, 0, 0}});
  wall("far", 0.5, {{0, depth, 0}, {width, depth, 0}, {width, depth, height}, {0, depth, height}});
}

/// A ball and a vase in a room under a lamp.
Scene ballAndVase() {
  SceneBuilder builder;
  room(builder, 4, 3, 2.5);
  turnedBody(builder, builder.surface("ball", 0.7), {1.2, 1, 0.7}, arc(0.5, -0.5, 0.5, 12), 24);
  turnedBody(builder, builder.surface("vase", 0.4), {2.8, 2, 0.2},
             {{0, 0}, {0.2, 0}, {0.3, 0.2}, {0.35, 0.4}, {0.3, 0.6}, {0.15, 0.8}, {0.2, 1}, {0.25, 1.05}, {0, 1.05}}, 24);
  builder.level(builder.surface("lamp", 0.1, 30), 1.7, 1.2, 2.3, 1.8, 2.4, false);
  return builder.scene();
}

/// A bowl under a lamp under the open sky: it sees itself.
Scene bowl() {
  SceneBuilder builder;
  turnedBody(builder, builder.surface("bowl", 0.8), {0, 0, 0}, arc(1, -0.5, 0, 16), 48, false);
  builder.level(builder.surface("lamp", 0.0, 10), -0.4, -0.2, 0.3, 0.4, 0.5, false);
  return builder.scene();
}

/// Hills lit by a lamp above them.
Scene hills() {
  SceneBuilder builder;
  const Index ground = builder.surface("ground", 0.6);
  constexpr int kSteps = 30;
  const auto point = [&](int i, int j) {
    const double x = 10.0 * i / kSteps;
    const double y = 10.0 * j / kSteps;
    return Vec3(x, y, std::sin(1.3 * x) * std::cos(0.9 * y) + 0.3 * std::sin(3.1 * x + 2 * y));
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      builder.face(ground, {point(i, j), point(i + 1, j), point(i + 1, j + 1)});
      builder.face(ground, {point(i, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  builder.level(builder.surface("lamp", 0.2, 50), 3, 3, 5, 5, 3, false);
  return builder.scene();
}

/// A hall with two rows of columns and a barrel vault.
Scene vault() {
  SceneBuilder builder;
  const Index stone = builder.surface("vault", 0.5);
  const double radius = 2;
  constexpr int kAround = 32;
  const auto rim = [&](int k, double y) {
    const double a = std::numbers::pi * k / kAround;
    return Vec3(2 - radius * std::cos(a), y, 2.5 + radius * std::sin(a));
  };
  constexpr int kAlong = 10;
  for (int k = 0; k < kAround; ++k) {
    for (int l = 0; l < kAlong; ++l) {
      builder.face(stone, {rim(k, 0.8 * l), rim(k, 0.8 * (l + 1)), rim(k + 1, 0.8 * (l + 1)), rim(k + 1, 0.8 * l)});
    }
  }
  builder.face(builder.surface("floor", 0.3), {{0, 0, 0}, {4, 0, 0}, {4, 8, 0}, {0, 8, 0}});
  builder.face(builder.surface("left", 0.6), {{0, 0, 0}, {0, 8, 0}, {0, 8, 2.5}, {0, 0, 2.5}});
  builder.face(builder.surface("right", 0.6), {{4, 0, 0}, {4, 0, 2.5}, {4, 8, 2.5}, {4, 8, 0}});
  const Index columns = builder.surface("columns", 0.7);
  for (int k = 0; k < 3; ++k) {
    for (const double x : {1.0, 3.0}) {
      builder.prism(columns, SceneBuilder::regularPolygon({x, 2.0 + 2 * k}, 0.2, 16), 0, 2.5);
    }
  }
  builder.box(builder.surface("lamp", 0.1, 20), {1.8, 3, 2}, {2.2, 5, 2.1});
  return builder.scene();
}

std::vector<double> powers(const PatchMesh& mesh, const Solution& solution) {
  std::vector<double> power(mesh.surface_names.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) power[mesh.surface[i]] += mesh.area[i] * solution.radiosity[3 * i];
  return power;
}

void compare(const char* name, const Scene& scene, std::size_t wanted, double reflectance_scale = 1) {
  Progress progress;
  MeshOptions options;
  options.patches = wanted;
  PatchMesh mesh = meshScene(scene, options, progress).mesh;
  if (!mesh.clusters) { fmt::print("{} {}: no clusters, {} patches\n", name, wanted, mesh.size()); return; }
  PatchMesh fine = mesh;
  fine.clusters.reset();
  FormFactorOptions how;
  how.method = getenv("EXACT") ? FormFactorMethod::exact : FormFactorMethod::hemicube;
  how.tolerance = 0.1;
  how.resolution = 128;
  how.symmetrize = true;
  how.precision = Precision::double_precision;
  const FormFactors factors = computeFormFactors(fine, how, progress);
  PatchMaterials materials = patchMaterials(scene, mesh);
  (void)reflectance_scale;
  const Solution reference = solve(factors, materials, fine, {}, progress);
  const Solution clustered = solve(clusterFactors(factors, mesh, progress), materials, mesh, {}, progress);
  const auto a = powers(fine, reference);
  const auto b = powers(mesh, clustered);
  double worst = 0; std::string who;
  for (std::size_t s = 0; s < a.size(); ++s) {
    const double e = std::abs(b[s] / a[s] - 1);
    if (e > worst) { worst = e; who = mesh.surface_names[s]; }
  }
  double err = 0, norm = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const double d = clustered.irradiance[3*i] - reference.irradiance[3*i];
    err += mesh.area[i]*d*d; norm += mesh.area[i]*reference.irradiance[3*i]*reference.irradiance[3*i];
  }
  if (getenv("V")) for (std::size_t t = 0; t < a.size(); ++t) {
    double e=0,h=0,area=0; std::size_t n=0; std::set<std::size_t> cs;
    for (std::size_t i = 0; i < mesh.size(); ++i) if (mesh.surface[i]==t) {
      const double d = clustered.irradiance[3*i] - reference.irradiance[3*i]; e+=mesh.area[i]*d*d; h+=mesh.area[i]*reference.irradiance[3*i]; area+=mesh.area[i]; ++n; cs.insert(mesh.unknownOf(i)); }
    fmt::print("  {:24s} area {:8.4f} patches {:5d} clusters {:5d} power err {:7.3f}%  H mean {:.3f} H rms err {:.3f} share of err {:.4f}\n", mesh.surface_names[t], area, n, cs.size(), 100*(b[t]/a[t]-1), h/area, std::sqrt(e/area), e/err);
  }
  if (getenv("W") && wanted == 2000) {
    std::vector<std::pair<double, std::size_t>> worst_c;
    for (std::size_t c = 0; c < mesh.unknowns(); ++c) { double e = 0;
      for (Index i : mesh.clusters->patchesOf(c)) { const double d = clustered.irradiance[3*i]-reference.irradiance[3*i]; e += mesh.area[i]*d*d; if (mesh.surface_names[mesh.surface[i]].substr(0,5)!="books") e=0; }
      worst_c.push_back({e,c}); }
    std::sort(worst_c.rbegin(), worst_c.rend());
    double tot=0; for (auto&x:worst_c) tot+=x.first;
    for (int k=0;k<8;++k) { fmt::print("cluster {} share {:.4f}\n", worst_c[k].second, worst_c[k].first/tot);
      for (Index i : mesh.clusters->patchesOf(worst_c[k].second)) { auto c=mesh.centroid[i]; auto n=mesh.normal[i]; fmt::print("    a {:.5f} c {:.3f} {:.3f} {:.3f} n {:.1f} {:.1f} {:.1f} ref {:.3f} got {:.3f} poly {}\n", mesh.area[i], c.x,c.y,c.z,n.x,n.y,n.z, reference.irradiance[3*i], clustered.irradiance[3*i], mesh.polygon[i]); } }
  }
  fmt::print("{:14s} wanted {:5d} patches {:5d} clusters {:5d}: worst power {:.3f}% ({}), irradiance relL2 {:.3f}\n", name, wanted, mesh.size(), mesh.unknowns(), 100 * worst, who, std::sqrt(err / norm));
}

TEST(Clusters, Experiment) {
  for (const std::size_t n : {60, 150, 400}) { if (getenv("V")) break;
    compare("ball+vase", ballAndVase(), n);
    compare("bowl", bowl(), n);
    compare("hills", hills(), n);
    compare("vault", vault(), n);
  }
  Scene curved = loadScene(RADIOSITY_SOURCE_DIR "/data/curved.obj", {});
  for (const std::size_t n : {100, 250, 500}) if (!getenv("V")) compare("curved", curved, n);
  Scene furnished = loadScene(RADIOSITY_SOURCE_DIR "/data/furnished-room.obj", {});
  for (const std::size_t n : {300, 800, 2000}) compare("furnished", furnished, n);
}

}  // namespace
}  // namespace radiosity
