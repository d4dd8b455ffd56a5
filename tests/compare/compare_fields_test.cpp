// Comparison of light on surfaces: figures that can be made by hand, meshes that differ, and
// refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "radiosity/compare.h"
#include "support/error_of.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

using test::errorOf;
using test::QuadMesh;

/// A unit square in z = 0 facing +z, n x n quads cut in two, with a colour field at its vertices.
LitMesh square(int n, const std::function<Vec3(const Vec3&)>& colour, bool flipped = false,
               const Vec3& offset = Vec3(0.0), double size = 1) {
  LitMesh mesh;
  mesh.file = "square";
  mesh.surface_names = {"square"};
  const auto at = [&](int i, int j) { return Vec3(double(i) / n, double(j) / n, 0); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const std::array<Vec3, 4> p = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      const auto first = Index(mesh.vertices.size());
      for (const Vec3& v : p) mesh.vertices.push_back(v * size + offset);
      for (std::array<Index, 3> t :
           {std::array<Index, 3>{0, 1, 2}, std::array<Index, 3>{0, 2, 3}}) {
        if (flipped) std::swap(t[1], t[2]);
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        mesh.colours.push_back({colour(p[t[0]]), colour(p[t[1]]), colour(p[t[2]])});
        mesh.face.push_back(Index(mesh.face_surface.size()));
        mesh.face_surface.push_back(0);
      }
    }
  }
  return mesh;
}

LightField light(const LitMesh& mesh) { return lightOf(mesh, LightUnit::radiosity); }

Vec3 ramp(const Vec3& p) { return {1 + p.x, 2 + p.y, 3 - p.x - p.y}; }

std::string refusal(const LightField& a, const LightField& b, const CompareOptions& options = {}) {
  return errorOf([&] { compare(a, b, options); });
}

TEST(CompareFields, FiguresEqualThoseMadeByHand) {
  // Two patches of area 1 and 3; A is 2 and 1 in each band, B is 3 and 1: the difference is
  // sqrt(1 * 1^2) over sqrt(1 * 2^2 + 3 * 1^2) in each band.
  QuadMesh builder;
  builder.grid("small", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("large", {1, 0, 0}, {3, 0, 0}, {0, 1, 0});
  const PatchMesh mesh = builder.build();
  const std::vector<double> a = {2, 2, 2, 1, 1, 1};
  const std::vector<double> b = {3, 3, 3, 1, 1, 1};
  const Comparison c = compare(lightOf(mesh, a, 3, "A"), lightOf(mesh, b, 3, "B"), {});
  EXPECT_NEAR(c.relativeL2(), std::sqrt(1.0 / 7), 1e-15);
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(c.relativeL2(band), std::sqrt(1.0 / 7), 1e-15);
  EXPECT_EQ(c.largest.surface, "small");
  EXPECT_EQ(c.largest.a, 2);
  EXPECT_EQ(c.largest.b, 3);
  EXPECT_NEAR(glm::distance(c.largest.place, Vec3(0.5, 0.5, 0)), 0, 1e-15);
  EXPECT_NEAR(c.sums.a[0], 5, 1e-15);
  EXPECT_NEAR(c.sums.b[0], 6, 1e-15);
  ASSERT_EQ(c.surfaces.size(), 2u);
  EXPECT_EQ(c.surfaces[0].name, "small");  // the larger share of the difference
  EXPECT_NEAR(c.surfaces[0].sums.relativeL2(), 0.5, 1e-15);
  EXPECT_EQ(c.surfaces[1].sums.relativeL2(), 0);
  EXPECT_NEAR(c.surfaces[1].given, 3, 1e-15);
  EXPECT_NEAR(c.difference[0], 1, 1e-15);  // luminance weights sum to 1
  EXPECT_EQ(c.difference[1], 0);
  EXPECT_EQ(c.matched_a, c.area_a);
}

TEST(CompareFields, EveryBandHasTheSameFiguresAloneAndAmongOthers) {
  QuadMesh builder;
  builder.grid("left", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 2);
  builder.grid("right", {1, 0, 0}, {3, 0, 0}, {0, 1, 0}, 2, 3);
  const PatchMesh mesh = builder.build();
  // The same squares cut otherwise: matched by position.
  QuadMesh other_builder;
  other_builder.grid("left", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 5);
  other_builder.grid("right", {1, 0, 0}, {3, 0, 0}, {0, 1, 0}, 4, 1);
  const PatchMesh other = other_builder.build();
  const auto valuesOf = [](const PatchMesh& of, std::size_t bands, std::size_t only) {
    std::vector<double> values;
    for (const Vec3& c : of.centroid) {
      for (std::size_t b = 0; b < bands; ++b) {
        if (only < bands && only != b) continue;
        values.push_back(1 + double(b) + c.x * (b % 2 == 0 ? 0.3 : -0.1) + double(b) * c.y);
      }
    }
    return values;
  };
  for (const std::size_t bands : {1U, 2U, 3U, 5U, 8U}) {
    for (const PatchMesh* second : {&mesh, &other}) {
      std::vector<double> lit = valuesOf(*second, bands, bands);
      for (double& value : lit) value = 1.5 * value + 0.25;
      const int width = int(bands);
      const Comparison all = compare(lightOf(mesh, valuesOf(mesh, bands, bands), width, "A"),
                                     lightOf(*second, lit, width, "B"), {});
      ASSERT_EQ(all.sums.a.size(), bands);
      std::vector<double> difference(all.difference.size(), 0.0);
      double dd = 0;
      double aa = 0;
      for (std::size_t b = 0; b < bands; ++b) {
        std::vector<double> lit_alone = valuesOf(*second, bands, b);
        for (double& value : lit_alone) value = 1.5 * value + 0.25;
        const Comparison alone = compare(lightOf(mesh, valuesOf(mesh, bands, b), 1, "A"),
                                         lightOf(*second, lit_alone, 1, "B"), {});
        // Sums are made band by band: the same bits.
        EXPECT_EQ(alone.sums.a[0], all.sums.a[b]);
        EXPECT_EQ(alone.sums.b[0], all.sums.b[b]);
        EXPECT_EQ(alone.relativeL2(0), all.relativeL2(int(b)));
        EXPECT_EQ(alone.relativeL2(), alone.relativeL2(0));
        EXPECT_EQ(alone.largest.band, 0);
        dd += alone.sums.dd[0];
        aa += alone.sums.aa[0];
        for (std::size_t k = 0; k < difference.size(); ++k) difference[k] += alone.difference[k];
      }
      EXPECT_EQ(all.relativeL2(), std::sqrt(dd / aa));
      // Three bands are colours, and have a luminance; all others are summed.
      if (bands != 3) {
        EXPECT_EQ(all.difference, difference);
      }
      EXPECT_EQ(all.largest.band, width - 1) << "the brightest";
    }
  }
}

TEST(CompareFields, DifferentBandsAreRefusedWithTheCure) {
  QuadMesh builder;
  builder.grid("square", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  const PatchMesh mesh = builder.build();
  const LightField eight = lightOf(mesh, std::vector<double>(32, 1.0), 8, "spectrum.h5");
  const LightField one = lightOf(mesh, std::vector<double>(4, 1.0), 1, "heat.h5");
  const std::string error = refusal(eight, one);
  EXPECT_NE(error.find("spectrum.h5 has 8 bands and heat.h5 has 1 band,"), std::string::npos)
      << error;
  EXPECT_NE(error.find("solve or gather both"), std::string::npos);
  EXPECT_NE(refusal(one, light(square(2, ramp))), "");
  const std::string sizes =
      errorOf([&] { lightOf(mesh, std::vector<double>(12, 1.0), 8, "short.h5"); });
  EXPECT_NE(sizes.find("short.h5: 12 radiosities are given for 4 patches of 8 bands; give 32"),
            std::string::npos)
      << sizes;
  EXPECT_NE(errorOf([&] {
              lightOf(mesh, std::vector<double>(4, 1.0), 1, "x", std::vector<double>(12, 0.0));
            }),
            "");
}

TEST(CompareFields, AFieldEqualsItselfOnOtherMeshes) {
  // A linear field is linear whatever triangles carry it; means over cells are exact for it.
  const LightField a = light(square(3, ramp));
  for (const int n : {1, 2, 5, 16}) {
    const Comparison c = compare(a, light(square(n, ramp)), {});
    EXPECT_LT(c.relativeL2(), 1e-14) << n;
    EXPECT_NEAR(c.matched_a, 1, 1e-12);
    EXPECT_NEAR(c.matched_b, 1, 1e-12);
  }
}

TEST(CompareFields, PatchesAreComparedWithMeans) {
  // Patches that hold the means of a linear field are equal to it, though they differ at every
  // point; and the cells are the patches', whichever side they are on.
  QuadMesh builder;
  builder.grid("square", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  const PatchMesh mesh = builder.build();
  std::vector<double> means;
  for (const Vec3& centroid : mesh.centroid) {
    for (int b = 0; b < 3; ++b) means.push_back(ramp(centroid)[b]);
  }
  const LightField patches = lightOf(mesh, means, 3, "patches");
  const LightField linear = light(square(7, ramp));
  // The ramp is linear, so both have the same means over the patches, to rounding.
  EXPECT_LT(compare(patches, linear, {}).relativeL2(), 1e-12);
  const Comparison turned = compare(linear, patches, {});
  EXPECT_LT(turned.relativeL2(), 1e-12);
  EXPECT_TRUE(turned.cells_of_b);
}

TEST(CompareFields, SidesOfASheetAreComparedSeparately) {
  // A sheet lit from above: its front is 1, its back 0. Both lie in one place.
  QuadMesh builder;
  builder.grid("sheet", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2, true);
  const PatchMesh mesh = builder.build();
  std::vector<double> values;
  for (std::size_t i = 0; i < mesh.size(); ++i)
    values.insert(values.end(), 3, mesh.side[i] ? 0 : 1);
  LitMesh both = square(3, [](const Vec3&) { return Vec3(1); });
  const LitMesh back = square(
      3, [](const Vec3&) { return Vec3(0); }, true);
  const auto shift = Index(both.vertices.size());
  both.vertices.insert(both.vertices.end(), back.vertices.begin(), back.vertices.end());
  for (std::size_t t = 0; t < back.triangles.size(); ++t) {
    const auto& corners = back.triangles[t];
    both.triangles.push_back({corners[0] + shift, corners[1] + shift, corners[2] + shift});
    both.colours.push_back(back.colours[t]);
    both.face.push_back(Index(both.face_surface.size()));
    both.face_surface.push_back(0);
  }
  EXPECT_EQ(compare(lightOf(mesh, values, 3, "A"), light(both), {}).relativeL2(), 0);
}

TEST(CompareFields, AnErrorOfPiIsFoundAndNamed) {
  const LitMesh mesh = square(4, ramp);
  const LightField radiosity = lightOf(mesh, LightUnit::radiosity);
  const LightField radiance = lightOf(mesh, LightUnit::radiance);  // the same numbers, times pi
  const Comparison c = compare(radiance, radiosity, {});
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_NE(c.notes[0].text.find("that is pi:"), std::string::npos) << c.notes[0].text;
  EXPECT_NE(c.notes[0].text.find("b_is='radiance'"), std::string::npos);
  EXPECT_NEAR(c.fitted_scale, std::numbers::pi, 1e-12);
  EXPECT_LT(c.fitted_l2, 1e-12);
  EXPECT_NEAR(c.relativeL2(), 1 - std::numbers::inv_pi, 1e-12);
  const Comparison turned = compare(radiosity, radiance, {});
  ASSERT_EQ(turned.notes.size(), 1u);
  EXPECT_NE(turned.notes[0].text.find("that is 1 / pi:"), std::string::npos);

  // 2.5 is not pi; a difference in shape is no factor.
  const auto scaled = [](const Vec3& p) { return 2.5 * ramp(p); };
  const Comparison other = compare(radiosity, light(square(4, scaled)), {});
  ASSERT_EQ(other.notes.size(), 1u);
  EXPECT_NE(other.notes[0].text.find("one factor"), std::string::npos);
  const auto shaped = [](const Vec3& p) { return ramp(Vec3(p.y, 1 - p.x, 0)) * (0.6 + p.x); };
  EXPECT_TRUE(compare(radiosity, light(square(4, shaped)), {}).notes.empty());
}

TEST(CompareFields, AConstantFactorIsFitted) {
  CompareOptions options;
  options.fit_scale = true;
  const auto scaled = [](const Vec3& p) { return 0.04 * ramp(p); };
  const Comparison c = compare(light(square(3, ramp)), light(square(4, scaled)), options);
  EXPECT_NEAR(c.scale, 25, 1e-9);
  EXPECT_LT(c.relativeL2(), 1e-12);
  EXPECT_TRUE(c.notes.empty());
}

TEST(CompareFields, CodedColoursNeedAFactorAndDropClippedValues) {
  // sRGB codes of x / 2 + 1 / 4, the right end of which is clipped at 1 when doubled.
  const auto coded = [](const Vec3& p) {
    const double linear = std::min(1.0, 2 * (0.25 + 0.5 * p.x));
    const double code =
        linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return Vec3(code);
  };
  const auto truth = [](const Vec3& p) { return Vec3(0.25 + 0.5 * p.x); };
  LitMesh screen = square(64, coded);
  screen.file = "screen.ply";
  const LightField b = lightOf(screen, LightUnit::srgb8);
  const LightField a = light(square(64, truth));
  const std::string error = refusal(a, b);
  EXPECT_NE(error.find("screen.ply"), std::string::npos) << error;
  EXPECT_NE(error.find("add fit_scale"), std::string::npos) << error;
  CompareOptions options;
  options.fit_scale = true;
  const Comparison c = compare(a, b, options);
  EXPECT_NEAR(c.scale, 0.5, 1e-3);
  // Vertex colours were decoded, then interpolated: exact at vertices, linear in between.
  EXPECT_LT(c.relativeL2(), 1e-3);
  EXPECT_NEAR(c.clipped, 0.5, 0.02);
  EXPECT_NEAR(c.sums.area + c.clipped, 1, 1e-12);
}

TEST(CompareFields, DifferentSurfacesAreRefusedWithTheReason) {
  const LightField a = light(square(3, ramp));
  const LightField far = light(square(3, ramp, false, {0, 0, 0.5}));
  const std::string apart = refusal(a, far);
  EXPECT_NE(apart.find("0.00% of A's area"), std::string::npos) << apart;
  EXPECT_NE(apart.find("0.5"), std::string::npos) << "the box of B is named: " << apart;
  EXPECT_NE(refusal(a, light(square(3, ramp, false, Vec3(0.0), 1000))).find("unit"),
            std::string::npos);
  const std::string flipped = refusal(a, light(square(3, ramp, true)));
  EXPECT_NE(flipped.find("faces the other way"), std::string::npos) << flipped;
  // Nothing matches: --partial does not help.
  CompareOptions partial;
  partial.partial = true;
  EXPECT_NE(refusal(a, far, partial), "");
}

TEST(CompareFields, PartsAreComparedOnRequest) {
  const LightField whole = light(square(4, ramp));
  LitMesh half = square(4, ramp);
  half.triangles.resize(16);
  half.colours.resize(16);
  half.face.resize(16);
  const LightField part = light(half);
  const std::string error = refusal(whole, part);
  EXPECT_NE(error.find("50.00% of A's area and 100.00% of B's"), std::string::npos) << error;
  EXPECT_NE(error.find("with partial"), std::string::npos);
  CompareOptions options;
  options.partial = true;
  const Comparison c = compare(whole, part, options);
  EXPECT_NEAR(c.matched_a, 0.5, 1e-2);  // up to --match past the edge
  EXPECT_NEAR(c.matched_b, 0.5, 1e-12);
  EXPECT_LT(c.relativeL2(), 1e-3);
  EXPECT_EQ(std::count_if(c.difference.begin(), c.difference.end(),
                          [](double d) { return std::isnan(d); }),
            16);
}

TEST(CompareFields, OptionsOutOfRangeAreRefused) {
  EXPECT_NO_THROW(CompareOptions().validate());
  for (const double match : {0.0, 0.2, double(NAN)}) {
    CompareOptions options;
    options.match = match;
    EXPECT_THROW(options.validate(), InputError) << match;
  }
}

}  // namespace
}  // namespace radiosity
