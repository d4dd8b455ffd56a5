// Options of the stages, from the scene to gathered light.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <optional>

#include "base/parse.h"
#include "cli/options.h"
#include "cli/validators.h"
#include "radiosity/names.h"
#include "radiosity/tables.h"

namespace radiosity::cli {

namespace {

double parseReflectance(const std::string& text) {
  const std::optional<double> value = parseNumber(text);
  if (!value) {
    throw InputError(fmt::format("--default-reflectance: '{}' is not a number", text));
  }
  return *value;
}

/// `kind`: a light as it is by default.
void addLightOption(CLI::App& app, Request& r, const Light& kind) {
  const std::string name = "--" + kind.name;
  const auto take = [&r, name, word = kind.name](const std::string& text) {
    const Light light = lightOf(word, text);
    nameOption(name, [&] { light.validate(); });
    setLight(r.scene.lights, light);
  };
  std::string value = kind.traits().strength;
  std::ranges::transform(value, value.begin(), [](unsigned char c) { return std::toupper(c); });
  app.add_option_function<std::string>(name, take, kind.traits().help)
      ->group("Scene")
      ->option_text(value + kind.parametersText());
}

/// Options that also apply to the scene in a results file.
void addOverrideOptions(CLI::App& app, Request& r) {
  add(app, "Scene", "--set", r.scene.set, "NAME.PROPERTY=VALUE",
      "Override a surface, material or object, those that a pattern matches ('*wall*') or all: "
      "reflectance (0 to 1), emission (exitance, W/m^2) or radiance (W/m^2/sr), which replace a "
      "texture, or tint, which keeps it and multiplies; one number or three (R,G,B). May be "
      "repeated");
  for (const Light& kind : lightKinds()) addLightOption(app, r, kind);
  app.add_option_function<std::string>(
         "--up", [&r](const std::string& text) { r.scene.up = named(kUpNames, text); },
         "Axis that points up, for cameras that nobody gave: y or z (default: z in .stl, .3mf, "
         ".msh, .inp, .vs3 and VTK's files, else y)")
      ->check(CLI::IsMember(namesIn(kUpNames)))
      ->group("Scene")
      ->option_text("y|z");
  add(app, "Scene", "--materials", r.scene.materials_file, "FILE.json",
      R"(Overrides from a file: {"NAME": {"reflectance": [R,G,B], "emission": [R,G,B]}})");
  add(app, "Scene", "--one-sided", r.scene.one_sided, "NAME|all",
      "Make surfaces one-sided: black from behind, but they block. May be repeated");
  add(app, "Scene", "--two-sided", r.scene.two_sided, "NAME|all",
      "Make surfaces two-sided (applied after --one-sided). May be repeated");
  add(app, "Scene", "--flip", r.scene.flip, "NAME|all",
      "Turn surfaces over: a room that faces outward, a cap that faces the other way. May be "
      "repeated");
  add(app, "Scene", "--without", r.scene.without, "NAME",
      "Leave surfaces out, for instance glass, which is solid here. May be repeated");
}

}  // namespace

void addSceneOptions(CLI::App& app, Request& r) {
  const SceneOptions defaults;
  const auto reading = [&app, &r](const std::string& name, auto assign, const char* placeholder,
                                  const std::string& description) {
    return app
        .add_option_function<std::string>(
            name,
            [&r, name, assign](const std::string& text) {
              assign(text);
              nameOption(name, [&r] { r.scene.validate(); });
              r.reading_options.push_back(name);
            },
            description)
        ->group("Scene")
        ->option_text(placeholder);
  };
  reading(
      "--unit", [&r](const std::string& t) { r.scene.unit = t; }, "UNIT",
      "Unit of the scene file: mm, cm, m, in or ft (default m)")
      ->check(CLI::IsMember({"mm", "cm", "m", "in", "ft"}));
  reading(
      "--kd-is", [&r](const std::string& t) { r.scene.kd_is_srgb = t == "srgb"; }, "SPACE",
      "How Kd and base colours are written: linear or srgb (default linear)")
      ->check(CLI::IsMember({"linear", "srgb"}));
  reading(
      "--default-reflectance",
      [&r](const std::string& t) { r.scene.default_reflectance = parseReflectance(t); }, "RHO",
      fmt::format("Reflectance of faces without a material, 0 to 1 (default {})",
                  defaults.default_reflectance));
  reading(
      "--vertex-colours",
      [&r](const std::string& t) {
        r.scene.vertex_colours = named(kVertexColoursNames, t).value();
      },
      "off|linear|srgb",
      "Multiply the reflectance by the colours of vertices, in linear or sRGB numbers; without a "
      "material they are the reflectance (default off; glTF's are always used, linear)")
      ->check(CLI::IsMember(namesIn(kVertexColoursNames)));
  reading(
      "--textures", [&r](const std::string& t) { r.scene.textures = t == "on"; }, "on|off",
      "Average textures over each patch (on, default) or use the material's factor alone")
      ->check(CLI::IsMember({"on", "off"}));
  addOverrideOptions(app, r);
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
  if (app.get_name() == commandName(Command::render)) {
    CLI::Option* tolerance = app.get_option("--tolerance");
    tolerance->description(
        fmt::format("{}; where elements are shown and no form factors are written, {} by default",
                    tolerance->get_description(), FormFactorOptions::kSourceTolerance));
  }
  app.add_flag_function(
         "--resume,!--no-resume", [&r](std::int64_t count) { r.resume = count > 0; },
         fmt::format("Keep rows in OUT.h5.rows as they are computed, and go on from those that a "
                     "run which was broken off has left; --no-resume: begin anew (default: resume, "
                     "and keep rows where they are foreseen to take {:g} s; given, always)",
                     JournalOptions().from_seconds))
      ->group("Form factors");
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
  add(app, "Tables", "--between", r.between, "groups|surfaces|patches",
      "Print the form factors between surfaces, joined by --group (groups; without any the "
      "surfaces), each on its own (surfaces), or between patches; and write these (default: .txt "
      "and .hdf5 patches, others groups)")
      ->check(CLI::IsMember({"groups", "surfaces", "patches"}));
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
