// Radiative heat exchange in meshed scenes: concentric spheres, sheets, files.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "heat/conditions.h"
#include "radiosity/heat.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

/// A scene of triangles of named surfaces.
struct Triangles {
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Index> of_triangle;
  std::vector<Material> materials;

  Index surface(const std::string& name, bool two_sided = false) {
    Material material;
    material.name = name;
    material.two_sided = two_sided;
    materials.push_back(material);
    return Index(materials.size() - 1);
  }
  void quad(Index of, Vec3 origin, Vec3 u, Vec3 v) {
    const auto first = Index(vertices.size());
    for (const Vec3& p : {origin, origin + u, origin + u + v, origin + v}) vertices.push_back(p);
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
    of_triangle.insert(of_triangle.end(), 2, of);
  }
  /// The inside of a box: its name is that of every wall but those given another.
  void room(Vec3 size, Index walls, Index floor, Index ceiling) {
    const Vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0);
    quad(floor, o, x, y);
    quad(ceiling, z, y, x);
    quad(walls, o, y, z);
    quad(walls, x, z, y);
    quad(walls, o, z, x);
    quad(walls, y, x, z);
  }
  /// An icosahedron whose faces are cut in four `times` times, on a sphere; fronts out or in.
  void sphere(Index of, double radius, int times, bool inward) {
    const double g = std::numbers::phi;
    std::vector<Vec3> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                             {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                             {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<std::array<Index, 3>> faces{
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int k = 0; k < times; ++k) {
      std::map<std::pair<Index, Index>, Index> middles;
      const auto middle = [&](Index a, Index b) {
        const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), Index(points.size()));
        if (fresh) points.push_back(glm::normalize(points[a]) + glm::normalize(points[b]));
        return at->second;
      };
      std::vector<std::array<Index, 3>> finer;
      for (const auto& [a, b, c] : faces) {
        const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
      }
      faces = std::move(finer);
    }
    const auto first = Index(vertices.size());
    for (const Vec3& p : points) vertices.push_back(glm::normalize(p) * radius);
    for (auto [a, b, c] : faces) {
      if (inward) std::swap(b, c);
      triangles.push_back({first + a, first + b, first + c});
      of_triangle.push_back(of);
    }
  }
  Scene scene() const { return sceneOfTriangles(vertices, triangles, materials, of_triangle); }
};

/// Conditions by surface, in the order of the scene's materials.
HeatConditions inOrder(std::vector<HeatCondition> conditions) {
  HeatConditions out{std::move(conditions), {}};
  for (Index s = 0; s < out.conditions.size(); ++s) out.of_surface.push_back(s);
  return out;
}

struct Solved {
  PatchMesh mesh;
  FormFactors factors;
  HeatSolution heat;
  std::vector<SurfaceHeat> surfaces;
};

Solved solved(const Scene& scene, const HeatConditions& conditions, const MeshOptions& mesh_options,
              const FormFactorOptions& options = {}) {
  Progress quiet;
  Solved s;
  s.mesh = meshScene(scene, mesh_options, quiet).mesh;
  s.factors = computeFormFactors(s.mesh, options, quiet);
  s.heat = solveHeat(s.factors, conditions, s.mesh, {}, quiet);
  s.surfaces = heatBySurface(s.heat, s.mesh, s.factors);
  return s;
}

// Q = sigma A1 (T1^4 - T2^4) / (1/eps1 + A1/A2 (1/eps2 - 1)) of concentric spheres (Howell, Menguc
// & Siegel): radii 1 and 2, 1000 K at .8 inside, 500 K at .5 outside. Polyhedra with vertices on
// the spheres miss their areas by a term in the square of the edge, so that errors fall to a
// quarter from one to the next, and a parabola through the last two ends near Q.
TEST(HeatScenes, ConcentricSpheresConvergeToTheirClosedForm) {
  const double truth = 445350.1654603;
  std::vector<double> error;
  for (const int times : {1, 2}) {
    Triangles t;
    t.sphere(t.surface("inner"), 1, times, false);
    t.sphere(t.surface("outer"), 2, times, true);
    FormFactorOptions exact;
    exact.method = FormFactorMethod::exact;
    const Solved s =
        solved(t.scene(), inOrder({test::at("inner", .8, 1000), test::at("outer", .5, 500)}),
               {.faces_as_patches = true}, exact);
    ASSERT_EQ(s.heat.summary.status, HeatStatus::converged);
    error.push_back(s.surfaces[0].radiated / truth - 1);
    RecordProperty("error_" + std::to_string(times), std::to_string(error.back()));
    EXPECT_NEAR(s.surfaces[1].radiated / s.surfaces[0].radiated, -1, 1e-3);  // closure: reported
    EXPECT_LT(std::abs(s.heat.summary.balance.imbalance), 1e-3 * truth);
    ASSERT_TRUE(s.surfaces[0].irradiance_error);
    EXPECT_GT(*s.surfaces[0].irradiance_error, 0);
  }
  EXPECT_LT(std::abs(error[1]), .06);
  EXPECT_NEAR(error[0] / error[1], 4, .5);
  // The parabola's error goes with the fourth power of the edge: .072^2.
  EXPECT_LT(std::abs((4 * error[1] - error[0]) / 3), .005);
}

/// A box with a hot floor, a cold ceiling and adiabatic walls, and perhaps a sheet half-way up.
Triangles boxWithSheet(bool sheet) {
  Triangles t;
  const Index walls = t.surface("walls");
  const Index floor = t.surface("floor");
  const Index ceiling = t.surface("ceiling");
  t.room({1, 1, 1}, walls, floor, ceiling);
  if (sheet) t.quad(t.surface("sheet", true), {0, 0, .5}, {1, 0, 0}, {0, 1, 0});
  return t;
}

// Floor and ceiling black; a black sheet that fills the box has one temperature on both of its
// sides by patch, and floor and ceiling mirror each other: sigma T^4 of sheets is the mean.
TEST(HeatScenes, BothSidesOfASheetHaveOneTemperature) {
  const Solved s = solved(boxWithSheet(true).scene(),
                          inOrder({test::condition("walls", .5), test::at("floor", 1, 800),
                                   test::at("ceiling", 1, 400), test::condition("sheet", 1)}),
                          {.patches = 300});
  const double mean = std::pow((std::pow(800, 4) + std::pow(400, 4)) / 2, .25);
  std::size_t backs = 0;
  for (std::size_t i = 0; i < s.mesh.size(); ++i) {
    if (s.mesh.surface[i] != 3) continue;
    ASSERT_NE(s.mesh.twin[i], kNone);
    EXPECT_EQ(s.heat.temperature[i], s.heat.temperature[s.mesh.twin[i]]);
    EXPECT_NEAR(s.heat.temperature[i], mean, .02 * mean);  // by form factors to 1e-3, at worst rows
    backs += s.mesh.side[i];
  }
  EXPECT_GT(backs, 0u);
  EXPECT_NEAR(s.surfaces[3].radiated, 0, 1e-6 * s.surfaces[1].radiated);
  EXPECT_NEAR(s.surfaces[1].radiated / -s.surfaces[2].radiated, 1, 1e-2);
}

// An adiabatic plate 3 mm above one at 77 K, both black and 1 m wide, under a sky of 300 K. The gap
// has 5.956e-3 of its view (Howell C-11): T^4 = .994044 77^4 + .005956 300^4.
TEST(HeatScenes, AThinGapLetsTheSkyIn) {
  Triangles t;
  const Index low = t.surface("low");
  t.quad(low, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  t.quad(t.surface("high"), {0, 0, .003}, {0, 1, 0}, {1, 0, 0});
  Progress quiet;
  Solved s;
  // A patch a plate has the closed form; triangles would not.
  MeshOptions options;
  options.patches = 2;
  s.mesh = meshScene(t.scene(), options, quiet).mesh;
  HeatOptions heat;
  heat.sky_temperature = 300;
  HeatCondition adiabatic = test::condition("high", 1);
  for (const FormFactorMethod method : {FormFactorMethod::exact, FormFactorMethod::rays}) {
    FormFactorOptions by;
    by.method = method;
    by.tolerance = 1e-4;
    s.factors = computeFormFactors(s.mesh, by, quiet);
    s.heat =
        solveHeat(s.factors, inOrder({test::at("low", 1, 77), adiabatic}), s.mesh, heat, quiet);
    s.surfaces = heatBySurface(s.heat, s.mesh, s.factors);
    // 1e-4 of the gap's share is .1 K by rays of 1e-4 of the row.
    EXPECT_NEAR(s.surfaces[1].temperature, 95.50, method == FormFactorMethod::exact ? .005 : .5);
    EXPECT_TRUE(s.heat.summary.usable());
  }
}

/// A box whose walls and floor are one object.
Scene namedScene() {
  Triangles t;
  const Index walls = t.surface("walls");
  const Index floor = t.surface("floor");
  const Index lid = t.surface("lid");
  t.room({1, 1, 1}, walls, floor, lid);
  Scene scene = t.scene();
  scene.surfaces[0].object = scene.surfaces[1].object = "shell";
  return scene;
}

HeatConditions given(const std::vector<std::string>& settings) {
  return readHeatConditions(namedScene(), "", settings);
}

TEST(HeatConditionsByName, SettingsFindSurfacesAndObjects) {
  const HeatConditions c = given({"*.emissivity=0.4", "*.flux=0", "shell.power=60",
                                  "lid.temperature=300", "lid.emissivity=300:0.1 800:0.25"});
  ASSERT_EQ(c.of_surface.size(), 3u);
  EXPECT_EQ(c.of_surface[0], c.of_surface[1]);
  const HeatCondition& shell = c.conditions[c.of_surface[0]];
  EXPECT_EQ(shell.name, "shell");
  EXPECT_EQ(shell.power, 60);
  EXPECT_FALSE(shell.flux);
  EXPECT_EQ(shell.emissivity[0].values, std::vector<double>{.4});
  const HeatCondition& lid = c.conditions[c.of_surface[2]];
  EXPECT_EQ(lid.temperature, 300);
  EXPECT_DOUBLE_EQ(lid.emissivity[0].at(425), .1375);
  EXPECT_DOUBLE_EQ(lid.emissivity[0].at(100), .1);
}

TEST(HeatConditionsByName, NamesOverridePatternsAndSettingsOverrideTheTable) {
  const auto temperatures = [](const std::string& table, const std::vector<std::string>& settings) {
    const HeatConditions c = readHeatConditions(
        namedScene(),
        ConditionText{"t.csv", "surface,emissivity,temperature_K\n" + table, settings, {}});
    std::vector<double> out;
    out.reserve(c.of_surface.size());
    for (const Index k : c.of_surface) out.push_back(c.conditions[k].temperature.value_or(0));
    return out;
  };
  using Temperatures = std::vector<double>;  // of walls, floor and lid
  EXPECT_EQ(temperatures("*l*,.5,1\nlid,,2\n", {}), (Temperatures{1, 1, 2}));
  EXPECT_EQ(temperatures("lid,.5,2\n*l*,.5,1\n", {}), (Temperatures{1, 1, 2}));
  EXPECT_EQ(temperatures("*,.5,1\nlid,.5,2\n", {"?l*.temperature=3"}), (Temperatures{1, 3, 2}));
  EXPECT_EQ(temperatures("*,.5,1\nlid,.5,2\n", {"lid.temperature=4", "*d.temperature=3"}),
            (Temperatures{1, 1, 4}));
  EXPECT_EQ(temperatures("*,.5,1\nlid,.5,2\n", {"*d.temperature=3"}), (Temperatures{1, 1, 3}));
  // The object's name is one, too.
  EXPECT_EQ(temperatures("*,.5,1\nsh*,.5,2\n", {}), (Temperatures{2, 2, 1}));
  EXPECT_NE(test::errorOf([&] {
              temperatures("*l*,.5,1\n*d,.5,2\n", {});
            }).find("t.csv:3: lid is named here and in t.csv:2"),
            std::string::npos);
}

TEST(HeatConditionsByName, GroupsAreNamedLikePatterns) {
  const auto read = [](const std::vector<std::string>& settings) {
    return readHeatConditions(namedScene(),
                              ConditionText{"", "", settings, {"box=walls", "box=floor"}});
  };
  const HeatConditions c =
      read({"*.emissivity=.5", "*.flux=0", "box.temperature=400", "floor.emissivity=.7"});
  const auto of = [&](std::size_t surface) { return c.conditions[c.of_surface[surface]]; };
  EXPECT_EQ(of(0).temperature, 400);
  EXPECT_EQ(of(1).temperature, 400);
  EXPECT_EQ(of(1).emissivity[0].values, std::vector<double>{.7});
  EXPECT_EQ(of(2).flux, 0);
  // Power is of a group together.
  const HeatConditions together = read({"*.emissivity=.5", "lid.temperature=300", "box.power=9"});
  EXPECT_EQ(together.of_surface[0], together.of_surface[1]);
  EXPECT_EQ(together.conditions[together.of_surface[0]].name, "box");
  EXPECT_NE(test::errorOf([&] {
              read({"*.emissivity=.5", "bix.power=9"});
            }).find("there are: box"),
            std::string::npos);
}

TEST(HeatConditionsByName, MaterialsGiveEmissivitiesWhereAsked) {
  Scene scene = namedScene();
  scene.materials[scene.surfaces[0].material].reflectance = Vec3(.3);
  scene.materials[scene.surfaces[1].material].reflectance = Vec3(.3, .2, .1);
  const auto emissivities = [&](const std::vector<std::string>& settings) {
    const HeatConditions c = readHeatConditions(scene, "", settings);
    std::vector<double> out;
    out.reserve(c.of_surface.size());
    for (const Index k : c.of_surface) out.push_back(c.conditions[k].emissivity[0].values[0]);
    EXPECT_TRUE(c.from_materials);
    return out;
  };
  using Values = std::vector<double>;  // of walls, floor and lid
  EXPECT_EQ(emissivities(
                {"*.flux=0", "*.emissivity=material", "floor.emissivity=.6", "lid.emissivity=.2"}),
            (Values{.7, .6, .2}));
  EXPECT_EQ(emissivities({"*.flux=0", "*.emissivity=.4", "walls.emissivity=.1",
                          "walls.emissivity=material"}),
            (Values{.7, .4, .4}));
  EXPECT_NE(test::errorOf([&] {
              emissivities({"*.flux=0", "*.emissivity=material"});
            }).find("material floor reflects the colour 0.3, 0.2, 0.1"),
            std::string::npos);
}

TEST(HeatConditionsByName, RowsAreFoundByNameOrNumber) {
  const std::vector<std::string> names = {"wall", "", "wall", "lid"};
  const std::vector<double> emissivity = {.1, .2, .3, .4};
  const auto read = [&](const std::vector<std::string>& settings) {
    return readHeatConditions(names, emissivity, ConditionText{"", "", settings, {}});
  };
  const HeatConditions c =
      read({"wall.temperature=300", "row 2.flux=5", "lid.flux=0", "lid.emissivity=.9"});
  ASSERT_EQ(c.of_surface.size(), 4u);
  const auto of = [&](std::size_t row) { return c.conditions[c.of_surface[row]]; };
  EXPECT_EQ(of(0).temperature, 300);
  EXPECT_EQ(of(1).flux, 5);
  EXPECT_EQ(of(1).name, "row 2");
  for (const auto& [row, value] : {std::pair(0, .1), {1, .2}, {2, .3}, {3, .9}}) {
    EXPECT_EQ(of(std::size_t(row)).emissivity[0].values, std::vector<double>{value}) << row;
  }
  const auto says = [&](const std::vector<std::string>& settings, const std::string& words) {
    const std::string message = test::errorOf([&] { read(settings); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says({"5.flux=0"}, "no row is called 5; there are: wall, lid, numbers from 1 to 4");
  says({"lid.flux=0", "2.flux=0"}, "no condition for row 1 (wall), row 3 (wall)");
  says({"*.flux=0", "wall.power=10"}, "whose emissivities in the file differ");
}

TEST(HeatConditionsByName, WrongConditionsAreNamed) {
  const auto says = [](const std::vector<std::string>& settings, const std::string& words) {
    const std::string message = test::errorOf([&] { given(settings); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says({"*.temperature=300"}, "no emissivity for walls, floor, lid: give one");
  says({"*.emissivity=.5", "*.flux=0", "lid.temperature=1e9"}, "above 1e+08 K");
  says({"*.emissivity=.5", "*.flux=0", "l?dd.flux=1"}, "l?dd matches no surface");
  says({"lid.temperature=300", "*.emissivity=0.5"}, "no condition for walls, floor");
  says({"door.temperature=3"}, "is called door; there are: floor, lid, walls, shell");
  says({"lid.heat=3"}, "`heat` is none of emissivity, temperature, flux");
  says({"lid.temperature"}, "is not NAME.PROPERTY=VALUE");
  says({"lid.temperature=-20"}, "temperatures are in kelvin");
  says({"lid.emissivity=1.2"}, "emissivity 1.2 is not within 0 and 1");
  says({"lid.emissivity=materail"}, "`materail` is neither one number nor a table like");
  says({"lid.emissivity=300:0.1 200:0.2"}, "do not increase");
  says({"*.power=5"}, "give them by name");
  says({"*.emissivity=.5", "*.flux=0", "shell.power=60", "walls.emissivity=.1"},
       "power and isothermal are of all that the name stands for");
  says({"*.emissivity=.5", "*.flux=0", "lid.temperature=300", "lid.flux=5"},
       "conditions='lid.flux=5': lid is heated here and by conditions='lid.temperature=300'");
  says({"*.emissivity=.5", "*.flux=0", "*l*.temperature=300", "*d.temperature=400"},
       "lid is heated here and by conditions='*l*.temperature=300'");
  says({"*.emissivity=.5", "*.flux=0", "lid.convection=5"}, "lid: has convection and no ambient");
  says({}, "no conditions are given");
}

}  // namespace
}  // namespace radiosity
