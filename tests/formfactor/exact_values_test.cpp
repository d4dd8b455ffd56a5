// The exact method through the public interface, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "formfactor/computed_factors.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"
#include "truth/closed_forms.h"

namespace radiosity {
namespace {

using test::cubeOfTriangles;
using test::MeshBuilder;
using truth::Corners;

using std::numbers::pi;

/// F from the patches of one surface to those of another, area to area.
double surfaceToSurface(const PatchMesh& mesh, const FormFactors& factors, const std::string& from,
                        const std::string& to) {
  double exchange = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.surface_names[mesh.surface[i]] != from) continue;
    area += mesh.area[i];
    pairsOf(*factors.matrix).forRow(i, [&](Index j, double f) {
      if (mesh.surface_names[mesh.surface[j]] == to) exchange += mesh.area[i] * f;
    });
  }
  return exchange / area;
}

// ---- Planar values

TEST(ExactValues, PlanarClosedFormsHoldToTenDigits) {
  ASSERT_FALSE(truth::closedForms().empty());
  for (const truth::ClosedForm& k : truth::closedForms()) {
    MeshBuilder builder;
    builder.polygon("from", {k.from});
    builder.polygon("to", {k.to});
    const PatchMesh mesh = builder.build();
    const FormFactors f = test::exactInDouble(mesh, 1e-11);
    // Ten digits of the value; the last digit of the table's own is 1e-13.
    EXPECT_NEAR(f.matrix->at(0, 1) / k.f, 1, 1e-10) << k.name;
    EXPECT_NEAR(f.matrix->at(1, 0) * mesh.area[1], k.f * mesh.area[0], 1e-10 * k.f) << k.name;
    EXPECT_EQ(f.report.exact.shaft_tests, 0u) << k.name;
  }
}

TEST(ExactValues, ACubeOfTrianglesHasKnownValues) {
  const PatchMesh mesh = cubeOfTriangles();
  const FormFactors f = test::exactInDouble(mesh, 1e-11);
  const double known[] = {0.211324865405187, 0.184424034121610, 0.0563375489264, 0.0760875888927,
                          0.0999124478491937};  // the last: half a face's, where diagonals cross
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(f.fronts[i], 1, 1e-10);
    pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
      double nearest = 1;
      for (const double k : known) nearest = std::min(nearest, std::abs(value / k - 1));
      EXPECT_LT(nearest, 1e-10) << i << " " << j << " " << value;
    });
  }
}

TEST(ExactValues, ObstructedPlatesInPatchesHaveTheirClosedForms) {
  for (const truth::ObstructedForm& k : truth::obstructedForms()) {
    const PatchMesh mesh = truth::blockedPlates({k.obstacle}, 8);
    const FormFactors f = test::exactInDouble(mesh, 1e-7);
    EXPECT_NEAR(surfaceToSurface(mesh, f, "lower", "upper"), k.f, 1e-6) << k.name;
    EXPECT_NEAR(surfaceToSurface(mesh, f, "upper", "lower"), k.f, 1e-6) << k.name;
  }
}

TEST(ExactValues, ObstructedPlatesToNineDigitsTakeFewPoints) {
  // Between critical lines Gauss points converge: halving cells towards kinks takes ten times the
  // points for a tenth of the error, above 1,000 a pair at 1e-6.
  std::size_t points = 0;
  std::size_t pairs = 0;
  for (const truth::ObstructedForm& k : truth::obstructedForms()) {
    const PatchMesh mesh = truth::blockedPlates({k.obstacle}, 8);
    const FormFactors f = test::exactInDouble(mesh, 1e-9);
    // Errors of 64 x 64 values, within 1e-9 of the mean form factor 1/128 each; truth has 13
    // digits.
    EXPECT_NEAR(surfaceToSurface(mesh, f, "lower", "upper"), k.f, 1e-9) << k.name;
    points += f.report.exact.points;
    pairs += f.report.exact.occluded;
  }
  EXPECT_LT(points, 250 * pairs);  // 140 were counted
}

// ---- Curved values: the tessellation's error goes with the square of the facets' width

/// Values of three meshes, each of twice as many facets as the one before: differences fall by 4,
/// but for the next even order, so the order measured is 2 within a quarter. The finest mesh is
/// then off by a third of the last difference.
void expectSecondOrder(const std::vector<double>& values, double truth, const std::string& what,
                       double slack = 0.25) {
  ASSERT_EQ(values.size(), 3u);
  const double last = std::abs(values[2] - values[1]);
  const double order = std::log2(std::abs(values[1] - values[0]) / last);
  EXPECT_NEAR(order, 2, slack) << what;
  EXPECT_NEAR(values[2], truth, 0.5 * last) << what << ": " << values[0] << " " << values[1];
}

/// A regular polygon at height z facing up or down, as triangles about its centre.
void disc(MeshBuilder& builder, const std::string& surface, double radius, double z, bool up,
          int sides) {
  Corners rim;
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * pi * (up ? k : -k) / sides;
    rim.emplace_back(radius * std::cos(a), radius * std::sin(a), z);
  }
  std::vector<Corners> wedges;
  wedges.reserve(std::size_t(sides));
  for (int k = 0; k < sides; ++k) {
    wedges.push_back({Vec3(0, 0, z), rim[std::size_t(k)], rim[std::size_t((k + 1) % sides)]});
  }
  builder.polygon(surface, {rim}, wedges);
}

TEST(ExactValues, CoaxialDiscsConvergeToSecondOrder) {
  const struct {
    double r1, r2, h, f;
  } cases[] = {{1, 1, 1, 0.381966011250105},   {1, 1, 0.1, 0.904875078027496},
               {1, 1, 2, 0.171572875253810},   {1, 1, 10, 0.00980486407215170},
               {0.5, 1, 1, 0.468871125850725}, {1, 2, 1, 0.763932022500210}};
  for (const auto& c : cases) {
    std::vector<double> values;
    for (const int sides : {12, 24, 48}) {
      MeshBuilder builder;
      disc(builder, "lower", c.r1, 0, true, sides);
      disc(builder, "upper", c.r2, c.h, false, sides);
      const PatchMesh mesh = builder.build();
      values.push_back(surfaceToSurface(mesh, test::exactInDouble(mesh, 1e-9), "lower", "upper"));
    }
    expectSecondOrder(values, c.f, "discs " + std::to_string(c.r1) + " " + std::to_string(c.h));
  }
}

/// A sphere as quadrilaterals between parallels and triangles at the poles.
void sphere(MeshBuilder& builder, const std::string& surface, double radius, int sides,
            bool inward) {
  const int rings = sides / 2;
  const auto at = [&](int ring, int k) {
    if (ring == 0) return Vec3(0, 0, -radius);
    if (ring == rings) return Vec3(0, 0, radius);
    const double polar = pi * ring / rings;
    const double a = 2 * pi * (k % sides) / sides;
    return radius *
           Vec3(std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), -std::cos(polar));
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sides; ++k) {
      Corners c = {at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)};
      if (ring == 0) c.erase(c.begin() + 1);
      if (ring == rings - 1) c.erase(c.begin() + 2);
      if (inward) std::reverse(c.begin(), c.end());
      builder.polygon(surface, {c});
    }
  }
}

TEST(ExactValues, ASphereInACubeConvergesToSecondOrder) {
  // From the solid to each face 1/6 by symmetry, for the tessellated one too; from a face to the
  // sphere by the area, which converges at second order.
  std::vector<double> values;
  for (const int sides : {8, 16, 32}) {
    MeshBuilder builder;
    sphere(builder, "sphere", 0.5, sides, false);
    builder.box("cube", Vec3(-1), Vec3(1), 1, true);
    const PatchMesh mesh = builder.build();
    const FormFactors f = test::exactInDouble(mesh);
    // Nothing stands between the sphere and the cube: closed forms, 1e-5 or better each.
    EXPECT_NEAR(surfaceToSurface(mesh, f, "sphere", "cube"), 1, 1e-5) << sides;
    EXPECT_EQ(surfaceToSurface(mesh, f, "sphere", "sphere"), 0) << sides;
    double from_a_face = 0;
    pairsOf(*f.matrix).forRow(mesh.size() - 1, [&](Index j, double value) {
      if (j < mesh.size() - 6) from_a_face += value;
    });
    values.push_back(from_a_face);
  }
  expectSecondOrder(values, 0.130899693899575, "face to sphere");
}

TEST(ExactValues, ConcentricSpheresSeeTheRatioOfTheirAreas) {
  for (const int sides : {8, 16}) {
    MeshBuilder builder;
    sphere(builder, "inner", 1, sides, false);
    sphere(builder, "outer", 2, sides, true);
    const PatchMesh mesh = builder.build();
    const FormFactors f = test::exactInDouble(mesh, 1e-5);
    double areas[2] = {0, 0};
    for (std::size_t i = 0; i < mesh.size(); ++i) areas[mesh.surface[i]] += mesh.area[i];
    // All light that leaves a convex solid reaches its enclosure: exact for the polyhedra. A row's
    // N occluded pairs are each within the tolerance's share 1/N, so that the sum is within it.
    const double ratio = areas[0] / areas[1];
    EXPECT_NEAR(surfaceToSurface(mesh, f, "outer", "inner"), ratio, 1e-5) << sides;
    EXPECT_NEAR(surfaceToSurface(mesh, f, "outer", "outer"), 1 - ratio, 1e-5) << sides;
    EXPECT_NEAR(ratio, 0.25, 1e-12) << sides;
  }
}

TEST(ExactValues, TheInsideOfASphereConvergesToSecondOrder) {
  // F_ij = A_j / (4 pi R^2) for any two parts: here a polar cap's patches to an equatorial band's.
  std::vector<double> values;
  for (const int sides : {16, 32, 64}) {
    MeshBuilder builder;
    sphere(builder, "sphere", 1, sides, true);
    const PatchMesh mesh = builder.build();
    const FormFactors f = test::exactInDouble(mesh);
    EXPECT_EQ(f.report.exact.shaft_tests, 0u) << "a convex room";
    // Northern cap above 45 degrees and southern hemisphere: heights are fractions of the sphere.
    double exchange = 0;
    double cap = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (mesh.centroid[i].z < std::sqrt(0.5)) continue;
      cap += mesh.area[i];
      pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
        if (mesh.centroid[j].z < 0) exchange += mesh.area[i] * value;
      });
    }
    values.push_back(exchange / cap);
  }
  expectSecondOrder(values, 0.5, "inside a sphere");
}

/// Wall panels of a cylinder about the z axis and the ring between two radii.
void cylinder(MeshBuilder& builder, const std::string& surface, double radius, double height,
              int sides, bool inward) {
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * pi * k / sides;
    const double b = 2 * pi * (k + 1 == sides ? 0 : k + 1) / sides;
    Vec3 from(radius * std::cos(a), radius * std::sin(a), 0);
    Vec3 to(radius * std::cos(b), radius * std::sin(b), 0);
    if (inward) std::swap(from, to);
    const Vec3 up(0, 0, height);
    builder.polygon(surface, {{from, to, to + up, from + up}});
  }
}

void annulus(MeshBuilder& builder, const std::string& surface, double inner, double outer, double z,
             int sides, bool up) {
  Corners out, in;
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * pi * k / sides;
    out.emplace_back(outer * std::cos(a), outer * std::sin(a), z);
    in.emplace_back(inner * std::cos(a), inner * std::sin(a), z);
  }
  std::vector<Corners> parts;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const std::size_t n = (k + 1) % out.size();
    parts.push_back({out[k], out[n], in[n], in[k]});
    if (!up) std::reverse(parts.back().begin(), parts.back().end());
  }
  std::reverse(in.begin(), in.end());
  if (!up) {
    std::reverse(in.begin(), in.end());
    std::reverse(out.begin(), out.end());
  }
  builder.polygon(surface, {out, in}, parts);
}

TEST(ExactValues, CoaxialCylindersConvergeToSecondOrder) {
  const struct {
    double r, h, inner, self, end, ends;
  } cases[] = {{1.5, 1, 0.440764445482524, 0.130879245368273, 0.214178154574602, 0.214889763599984},
               {2, 1, 0.232274498243894, 0.137728613978354, 0.314998443888876, 0.401518406977428},
               {2, 2, 0.337106027518950, 0.228481018987999, 0.217206476746525, 0.203590765367867},
               {2, 4, 0.412627910213824, 0.328598251206169, 0.129386919290003, 0.0769441910235131},
               {3, 1, 0.0924807991439166, 0.117156531645591, 0.395181334605246, 0.613294298725034}};
  for (const auto& c : cases) {
    std::map<std::string, std::pair<double, std::vector<double>>> values;
    for (const int sides : {12, 24, 48}) {
      MeshBuilder builder;
      cylinder(builder, "inner", 1, c.h, sides, false);
      cylinder(builder, "outer", c.r, c.h, sides, true);
      annulus(builder, "low", 1, c.r, 0, sides, true);
      annulus(builder, "high", 1, c.r, c.h, sides, false);
      const PatchMesh mesh = builder.build();
      const FormFactors f = test::exactInDouble(mesh, 1e-4);
      EXPECT_TRUE(f.report.closed);
      const auto add = [&](const char* what, const char* from, const char* to, double value) {
        values[what].first = value;
        values[what].second.push_back(surfaceToSurface(mesh, f, from, to));
      };
      add("outer to inner", "outer", "inner", c.inner);
      add("outer to itself", "outer", "outer", c.self);
      add("outer to a ring", "outer", "low", c.end);
      add("ring to ring", "low", "high", c.ends);
    }
    for (const auto& [what, value] : values) {
      // From wall to ring the second-order terms of the two nearly cancel, and the next show.
      expectSecondOrder(value.second, value.first,
                        what + " at " + std::to_string(c.r) + " " + std::to_string(c.h), 0.5);
    }
  }
}

// ---- By construction

/// Reciprocity and bounds hold to rounding whatever the tolerance: F_ji is A_i F_ij / A_j, and its
/// product with A_j is back within two roundings.
void expectBounds(const PatchMesh& mesh, const FormFactors& f) {
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
      EXPECT_GE(value, 0);
      const double exchange = mesh.area[i] * value;
      EXPECT_NEAR(mesh.area[j] * f.matrix->at(j, i), exchange, 4e-16 * exchange);
      EXPECT_LE(exchange, std::min(mesh.area[i], mesh.area[j]) * (1 + 4e-16)) << i << " " << j;
    });
  }
}

TEST(ExactBounds, ObstructedIsNeverMoreThanUnobstructed) {
  for (const truth::ObstructedForm& k : truth::obstructedForms()) {
    for (const double tolerance : {1e-1, 1e-3, 1e-6}) {
      const PatchMesh with = truth::blockedPlates({k.obstacle}, 6);
      const PatchMesh without = truth::blockedPlates({}, 6);
      const FormFactors f = test::exactInDouble(with, tolerance);
      const FormFactors free = test::exactInDouble(without, tolerance);
      expectBounds(with, f);
      for (std::size_t i = 0; i < without.size(); ++i) {
        for (std::size_t j = 0; j < without.size(); ++j) {
          EXPECT_LE(f.matrix->at(i, j), free.matrix->at(i, j)) << k.name << " " << i << " " << j;
        }
      }
    }
  }
}

}  // namespace
}  // namespace radiosity
