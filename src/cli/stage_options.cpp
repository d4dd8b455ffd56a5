// Options of the stages, from the scene to gathered light.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "cli/options.h"
#include "cli/validators.h"
#include "radiosity/light_file.h"
#include "radiosity/tables.h"

namespace radiosity::cli {

namespace {

/// The option of a kind of which a scene has one.
void addLightOption(CLI::App& app, Request& r, const Light& kind) {
  const std::string name = "--" + kind.name;
  const auto take = [&r, name, word = kind.name](const std::string& text) {
    const Light light = lightOf(word, text);
    nameOption(name, [&] { light.validate(); });
    addLight(r.scene.lights, light);
  };
  std::string value = kind.traits().strength;
  std::ranges::transform(value, value.begin(), [](unsigned char c) { return std::toupper(c); });
  app.add_option_function<std::string>(name, take, kind.traits().help)
      ->group("Scene")
      ->option_text(value);
}

/// The option of all kinds.
void addLightsOption(CLI::App& app, Request& r) {
  std::string kinds;
  for (const Light& kind : lightKinds()) {
    const LightTraits& traits = kind.traits();
    kinds += fmt::format("{}{} ({}, {} or {}", kinds.empty() ? "" : "; ", traits.word,
                         traits.strength, traits.unit, traits.photometric);
    for (const std::string& parameter : kind.parameterNames()) kinds += ", " + parameter;
    kinds += ")";
  }
  const auto take = [&r](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const Light light = lightOf(text);
      nameOption("--light", [&] { light.validate(); });
      addLight(r.scene.lights, light);
    }
  };
  app.add_option_function<std::vector<std::string>>(
         "--light", take,
         "A light without a surface, e.g. point,800cd,at=1,2,2.5,name=desk, or a power, 900lm; it "
         "replaces the scene's of its name. May be repeated. Kinds, with the strength, which may "
         "be one number or R,G,B, and what else they take: " +
             kinds)
      ->group("Scene")
      ->option_text("KIND,STRENGTH,...")
      ->allow_extra_args(false);
  const auto take_file = [&r](const std::string& path) {
    nameOption("--lights", [&] { addLights(path, r.scene.lights); });
    r.light_lists.push_back(path);
  };
  app.add_option_function<std::string>(
         "--lights", take_file,
         "Lights of a list, as --light has them: [{\"kind\": \"ies\", \"file\": \"panel.ldt\", "
         "\"at\": [1, 2, 2.5], \"name\": \"desk\"}]; files of lamps are sought beside it, and no "
         "two have the "
         "same name")
      ->group("Scene")
      ->option_text("FILE.json");
}

}  // namespace

void addSceneOptions(CLI::App& app, Request& r) {
  addOptionsOf<SceneOptions>(app, r, "Scene");
  addOptionsOf<SceneOverrides>(app, r, "Scene");
  for (const Light& kind : lightKinds()) {
    if (kind.traits().single) addLightOption(app, r, kind);
  }
  addLightsOption(app, r);
}

void addMeshOptions(CLI::App& app, Request& r) {
  addOptionsOf<MeshOptions>(app, r, "Mesh");
  CLI::Option* max_edge = app.get_option("--max-edge");
  CLI::Option* faces = app.get_option("--faces-as-patches");
  app.get_option("--patches")->excludes(max_edge)->excludes(faces);
  max_edge->excludes(faces);
}

namespace {

std::string methodsText() {
  std::string text;
  for (const MethodTraits& method : kMethods) {
    if (method.summary.empty() || method.method == FormFactorMethod::automatic) continue;
    text += fmt::format("{} ({}), ", method.word, method.summary);
  }
  return text + "or auto (default): " + std::string(traitsOf(FormFactorMethod::automatic).summary);
}

}  // namespace

void addFactorOptions(CLI::App& app, Request& r) {
  addOptionsOf<FormFactorOptions>(app, r, "Form factors");
  app.get_option("--method")->description(methodsText());
  if (app.get_name() == commandName(Command::render) ||
      app.get_name() == commandName(Command::illuminance)) {
    CLI::Option* tolerance = app.get_option("--tolerance");
    tolerance->description(fmt::format(
        "{}; where elements are shown or points measured and no form factors are written, {} by "
        "default",
        tolerance->get_description(), FormFactorOptions::kSourceTolerance));
  }
  addOptionsOf<JournalOptions>(app, r, "Form factors");
}

void addAreasOption(CLI::App& app, Request& r, const char* group) {
  add(app, group, "--areas", r.areas, "FILE",
      "Areas of the rows of a matrix from a file (.mtx, .vf), m^2: a number a line, or a .csv with "
      "a column area_m2 (default: those in the file)");
}

void addMatrixOptions(CLI::App& app, Request& r) {
  addAreasOption(app, r, "Matrix");
  add(app, "Matrix", "--rows", r.rows, "FILE.csv",
      "Reflectance and emission of the rows of a matrix from a file: columns row (from 1) or name "
      "(* for all others), reflectance, emission (exitance, W/m^2); of several bands "
      "reflectance_1, ...");
}

void addTableOptions(CLI::App& app, Request& r) {
  add(app, "Tables", "--between", r.between, "groups|surfaces|patches|N",
      "Print the form factors between surfaces, joined by --group (groups; without any the "
      "surfaces), each on its own (surfaces), between about N nodes, parts of surfaces that are "
      "near each other and face alike, or between patches; and write these (default: .txt, .hdf5 "
      "and .mtx patches, others groups)")
      ->check(rowsOfTables());
  add(app, "Tables", "--group", r.groups, "NAME=PATTERN",
      "Join surfaces under one name in tables; * and ? stand for any text and any character, a "
      "surface belongs to the first group that matches it. Patches and form factors stay. May be "
      "repeated");
  add(app, "Tables", "--layout", r.layout, "wide|long",
      "A row a surface and a column a receiver (wide, default), or a row a pair (long)")
      ->check(CLI::IsMember(namesIn(kTableLayoutNames)));
  add(app, "Tables", "--sky-name", r.sky_name, "NAME",
      "What the sky is called among the receivers (default sky)");
  add(app, "Tables", "--zone", r.zone, "NAME",
      "EnergyPlus (.idf): the zone, zone list or enclosure (default: the input's name)");
}

void addBasisOption(CLI::App& app, Request& r) {
  add(app, "Solve", "--basis", r.basis, "surfaces|FILE.csv",
      "Beside the solution, one for each lamp by itself, all in the same passes: a set for each "
      "surface that emits and one for the sky; or sets from a table with the columns set,name,"
      "emission (exitance, W/m^2; or r,g,b), names as --set has them. A results file keeps them");
}

void addMixOption(CLI::App& app, Request& r) {
  add(app, "Solve", "--mix", r.mix, "NAME=WEIGHT,...",
      "Show light of single lamps, of solve --basis, each times its weight (>= 0), without a "
      "solve; sets that are not named are off");
}

}  // namespace radiosity::cli
