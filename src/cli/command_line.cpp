// The command line's words: options, help, and what is said when they are wrong.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "base/luminance.h"
#include "cli/command_texts.h"
#include "cli/help_formatter.h"
#include "cli/request.h"
#include "cli/validators.h"
#include "cli/words.h"
#include "radiosity/names.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

constexpr std::array kCommands = {Command::info,   Command::mesh,   Command::factors,
                                  Command::solve,  Command::gather, Command::compare,
                                  Command::render, Command::view};

// Each helper names the value as help shows it, and gives it one argument a time, so that
// "-o a.png scene.obj" does not take the scene for an output.
template <class Value>
CLI::Option* add(CLI::App& app, const char* group, const std::string& names, Value& value,
                 const char* placeholder, const std::string& description) {
  CLI::Option* option = app.add_option(names, value, description);
  option->group(group)->option_text(placeholder)->allow_extra_args(false);
  return option;
}

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
      [&r](const std::string& t) { r.scene.default_reflectance = std::stod(t); }, "RHO",
      fmt::format("Reflectance of faces without a material, 0 to 1 (default {})",
                  defaults.default_reflectance))
      ->check(CLI::Number);
  reading(
      "--textures", [&r](const std::string& t) { r.scene.textures = t == "on"; }, "on|off",
      "Average textures over each patch (on, default) or use the material's factor alone")
      ->check(CLI::IsMember({"on", "off"}));
  add(app, "Scene", "--set", r.scene.set, "NAME.PROPERTY=VALUE",
      "Override a surface, material or object: reflectance (0 to 1), emission (exitance, W/m^2) "
      "or radiance (W/m^2/sr), which replace a texture, or tint, which keeps it and multiplies; "
      "one "
      "number or three (R,G,B). May be repeated");
  app.add_option_function<std::string>(
         "--sky", [&r](const std::string& text) { r.scene.sky = parseSky(text); },
         "Light an open scene from every direction in which nothing stands, also from below: "
         "radiance, W/m^2/sr; one number or R,G,B (default 0). Pictures show it, opaque, where "
         "nothing is hit")
      ->group("Scene")
      ->option_text("RADIANCE");
  add(app, "Scene", "--materials", r.scene.materials_file, "FILE.json",
      R"(Overrides from a file: {"NAME": {"reflectance": [R,G,B], "emission": [R,G,B]}})");
  add(app, "Scene", "--one-sided", r.scene.one_sided, "NAME|all",
      "Make surfaces one-sided: black from behind, but they block. May be repeated");
  add(app, "Scene", "--two-sided", r.scene.two_sided, "NAME|all",
      "Make surfaces two-sided (applied after --one-sided). May be repeated");
}

void addMeshOptions(CLI::App& app, Request& r) {
  const MeshOptions defaults;
  CLI::Option* patches = add(app, "Mesh", "--patches", r.patches, "N",
                             fmt::format("About how many patches (default {}); where a scene has "
                                         "more planar pieces than that, they share as many "
                                         "unknowns",
                                         defaults.patches))
                             ->check(wholeNumber());
  CLI::Option* max_edge = add(app, "Mesh", "--max-edge", r.max_edge, "METRES",
                              "Longest edge of a patch (default: derived from --patches)");
  add(app, "Mesh", "--weld", r.weld, "FRACTION",
      fmt::format("Points closer than this fraction of the scene's diagonal are one; 0 to 0.01 "
                  "(default {})",
                  defaults.weld));
  CLI::Option* faces = app.add_flag_function(
                              "--faces-as-patches,!--no-faces-as-patches",
                              [&r](std::int64_t count) { r.faces_as_patches = count > 0; },
                              "Patch k is face k of the file: nothing is welded, cut or re-ordered")
                           ->group("Mesh");
  patches->excludes(max_edge)->excludes(faces);
  max_edge->excludes(faces);
}

void addFactorOptions(CLI::App& app, Request& r) {
  const FormFactorOptions defaults;
  add(app, "Form factors", "--method", r.method, "METHOD",
      "exact (area to area, hidden parts clipped off), rays (area to area, by counting rays), "
      "hemicube (seen from one point a patch), or auto (default): exact or rays, by what a sample "
      "of rows takes; the report says why")
      ->check(CLI::IsMember(namesIn(kMethodNames)));
  // Where results are compared, --tolerance is about the difference.
  const bool compares = app.get_name() == commandName(Command::compare);
  const std::string of_pictures =
      app.get_name() != commandName(Command::render)
          ? ""
          : fmt::format("; where elements are shown and no form factors are written, {} by default",
                        FormFactorOptions::kSourceTolerance);
  add(app, "Form factors", compares ? "--factor-tolerance" : "--tolerance", r.tolerance, "FRACTION",
      fmt::format("exact: error aimed at for an occluded pair, relative to the mean form factor "
                  "1/N (default {}); rays: relative error of a row, L2 (default {}, or what {:g} "
                  "million rays reach); 1e-12 to 0.1{}",
                  FormFactorOptions::kExactTolerance, FormFactorOptions::kRayTolerance,
                  1e-6 * FormFactorOptions::kMostRaysUnasked, of_pictures));
  add(app, "Form factors", "--closure", r.closure, "off|report|enforce",
      "In a closed scene say how far row sums are from 1 (report, default), or make them 1 by the "
      "smallest change to occluded pairs (enforce); rays: rows are closed unless off")
      ->check(CLI::IsMember(namesIn(kClosureNames)));
  add(app, "Form factors", "--resolution", r.resolution, "PIXELS",
      fmt::format("hemicube: edge of the top face; even, 16 to 4096 (default {})",
                  defaults.resolution));
  add(app, "Form factors", "--seed", r.seed, "N",
      fmt::format("rays: seed of their directions; hemicube: of the random turns (default {})",
                  defaults.seed))
      ->check(wholeNumber());
  app.add_flag_function(
         "--symmetrize,!--no-symmetrize", [&r](std::int64_t count) { r.symmetrize = count > 0; },
         "hemicube: merge both estimates of each pair (A_i F_ij = A_j F_ji), then restore the row "
         "sums")
      ->group("Form factors");
  add(app, "Form factors", "--near", r.near_pairs, "exact|off",
      "hemicube: area-to-area values times the visible fraction for pairs closer than about two "
      "patch sizes (default: off)")
      ->check(CLI::IsMember({"exact", "off"}));
  add(app, "Form factors", "--precision", r.precision, "auto|single|double",
      "Of the stored form factors (default auto: single unless --tolerance is below 1e-6); sums "
      "are "
      "always double")
      ->check(CLI::IsMember({"auto", "single", "double"}));
  add(app, "Form factors", "--memory-limit", r.memory_limit, "SIZE",
      "Keep form factors that need more memory in a nameless file beside the output, and refuse "
      "those that still do not fit: bytes, or 512M, 2G, ... (default: no limit)");
  app.add_flag_function(
         "--resume,!--no-resume", [&r](std::int64_t count) { r.resume = count > 0; },
         fmt::format("Keep rows in OUT.h5.rows as they are computed, and go on from those that a "
                     "run which was broken off has left; --no-resume: begin anew (default: resume, "
                     "and keep rows where they are foreseen to take {:g} s; given, always)",
                     JournalOptions().from_seconds))
      ->group("Form factors");
}

void addSolveOptions(CLI::App& app, Request& r) {
  const SolveOptions defaults;
  add(app, "Solve", "--solver", r.solver, "NAME", "gauss-seidel (default) or jacobi")
      ->check(CLI::IsMember(namesIn(kSolverNames)));
  add(app, "Solve", "--solve-tolerance", r.solve_tolerance, "RATIO",
      fmt::format("Stop when the largest residual is at most this times the largest emission "
                  "(default {})",
                  defaults.tolerance));
  add(app, "Solve", "--max-iterations", r.max_iterations, "N",
      fmt::format("Sweeps at most; then exit code 1 (default {})", defaults.max_iterations));
}

void addGatherOptions(CLI::App& app, Request& r) {
  const GatherOptions defaults;
  add(app, "Gather", "--at", r.gather_at, "vertices|patches",
      "Where the eyes stand: at vertices (default), one for each smooth side, so that radiosity is "
      "interpolated over patches; or at the centres of patches, one radiosity each")
      ->check(CLI::IsMember(namesIn(kGatherAtNames)));
  add(app, "Gather", "--passes", r.passes, "K",
      fmt::format("Passes at most: pass k adds the k-th bounce (default {})", defaults.passes));
  add(app, "Gather", "--gather-tolerance", r.gather_tolerance, "RATIO",
      fmt::format("Stop when further passes add at most this times the largest emission (default "
                  "{})",
                  defaults.tolerance));
  add(app, "Gather", "--crease", r.crease, "DEGREES",
      fmt::format("A vertex looks once per side that bends less (default {})", defaults.crease));
}

/// Options shared with the form factors.
void addEyeOptions(CLI::App& app, Request& r) {
  const GatherOptions defaults;
  add(app, "Gather", "--resolution", r.resolution, "PIXELS",
      fmt::format("Edge of the hemicube's top face; even, 16 to 4096 (default {})",
                  defaults.resolution));
  add(app, "Gather", "--seed", r.seed, "N",
      fmt::format("Seed of each hemicube's random turn (default {})", defaults.seed))
      ->check(wholeNumber());
}

void addCompareOptions(CLI::App& app, Request& r) {
  const CompareOptions defaults;
  app.add_option("B", r.second, "The file to compare with A; none with --gather")->option_text(" ");
  app.add_flag(
         "--gather", r.with_gather,
         "Compare the matrix solution of A with the gather method, running missing stages first")
      ->group("Compare");
  for (const auto& [name, value] : {std::pair("--a-is", &r.a_is), std::pair("--b-is", &r.b_is)}) {
    add(app, "Compare", name, *value, "radiosity|radiance|srgb8",
        "What the numbers of the file mean: W/m^2, W/m^2/sr, or coded for a screen (default: as "
        "the file says; where it does not, this is needed)")
        ->check(CLI::IsMember({"radiosity", "radiance", "srgb8"}));
  }
  app.add_flag("--fit-scale", r.fit_scale, "Multiply B by the factor that fits best, and print it")
      ->group("Compare");
  app.add_flag("--partial", r.partial,
               "Compare the parts that match even where they are less than 99% of either side")
      ->group("Compare");
  add(app, "Compare", "--match", r.match, "FRACTION",
      fmt::format("How far apart points of one surface may be, of A's diagonal (default {})",
                  defaults.match));
  add(app, "Compare", "--tolerance", r.compare_tolerance, "RATIO",
      "Exit with 1 where the relative L2 difference is above it (default: exit with 0)")
      ->check(nonNegative());
}

/// Two files are compared as they are; with --gather both sides are made here.
void bindToGather(CLI::App& app) {
  CLI::Option* gather = app.get_option("--gather");
  for (const char* name : {"--a-is", "--b-is"}) app.get_option(name)->excludes(gather);
  for (CLI::Option* option : app.get_options()) {
    const std::string& group = option->get_group();
    if (group != "General" && group != "Compare" && group != "Picture" && !option->get_positional())
      option->needs(gather);
  }
}

void addCameraOption(CLI::App& app, Request& r) {
  add(app, "Picture", "--camera", r.camera, "CAMERA",
      "Name of a camera in the scene, or eye=X,Y,Z;target=X,Y,Z[;up=X,Y,Z][;fov=DEGREES], metres "
      "(default: the scene's first, else one in a room at eye height, or from outside where there "
      "is none, aimed at lit surfaces)");
}

void addCameraOptions(CLI::App& app, Request& r) {
  addCameraOption(app, r);
  const RenderOptions defaults;
  add(app, "Picture", "--width", r.width, "PIXELS", fmt::format("Default {}", defaults.width));
  add(app, "Picture", "--height", r.height, "PIXELS",
      "Default: from the width and the camera's aspect ratio; the width, where it has none");
}

void addExposureOption(CLI::App& app, Request& r, const char* shown_in) {
  add(app, "Picture", "--exposure", r.exposure, "auto|EV",
      fmt::format("{} radiance times 2^EV (default auto; the EV is printed)", shown_in));
}

void addCreaseOption(CLI::App& app, Request& r) {
  add(app, "Picture", "--crease", r.crease, "DEGREES",
      fmt::format("Interpolate across edges that bend less (default {})", RenderOptions().crease));
}

void addRenderOptions(CLI::App& app, Request& r) {
  const RenderOptions defaults;
  addExposureOption(app, r, "The .png and .glb show");
  add(app, "Picture", "--samples", r.samples, "N",
      fmt::format("N x N samples a pixel, 1 to 16 (default {})", defaults.samples));
  app.add_flag("--flat", r.flat, "One colour a patch, not interpolated")->group("Picture");
  add(app, "Picture", "--backs", r.backs, "hide|show",
      "hide: look through the backs of one-sided surfaces (default); show: they are black")
      ->check(CLI::IsMember({"hide", "show"}));
}

void addLightmapOptions(CLI::App& app, Request& r) {
  const LightmapOptions defaults;
  add(app, "Lightmap", "--lightmap", r.lightmap, "FILE.exr",
      "Write light as an image, and the scene's own mesh, with coordinates for it, as the .glb of "
      "-o "
      "(of a glTF file with its nodes, names, materials, textures and normals)");
  add(app, "Lightmap", "--lightmap-size", r.lightmap_size, "TEXELS",
      fmt::format("Width and height, {} to {} (default {})", LightmapOptions::kSmallest,
                  LightmapOptions::kLargest, defaults.size));
  add(app, "Lightmap", "--lightmap-shows", r.lightmap_shows, "QUANTITY",
      "irradiance (default): what arrives, for viewers that multiply it by material and texture; "
      "radiosity: what leaves, textures averaged over patches; W/m^2")
      ->check(CLI::IsMember(namesIn(kLightmapShowsNames)));
}

void addElementOptions(CLI::App& app, Request& r) {
  const ElementOptions defaults;
  app.add_option_function<std::string>(
         "--elements", [&r](const std::string& text) { r.elements = text == "on"; },
         "on: light is evaluated anew at the vertices of elements, finer than patches where light "
         "changes (default of pictures and lit meshes); a results file keeps those of a lit mesh, "
         "and others where on is given; off: what the patches have, smoothed")
      ->group("Elements")
      ->option_text("on|off")
      ->check(CLI::IsMember({"on", "off"}));
  add(app, "Elements", "--element-tolerance", r.element_tolerance, "SHARE",
      fmt::format(
          "Elements are cut where interpolation misses by more than this share of the light "
          "there, and have more rays where those of indirect light are spread by seven times that; "
          "1e-4 to 0.5 (default {})",
          defaults.tolerance));
}

void addFinalGatherOption(CLI::App& app, Request& r) {
  app.add_flag(
         "--final-gather", r.final_gather,
         fmt::format("Evaluate light at every pixel, not at the vertices of elements: {} rays "
                     "a pixel, many times slower, without interpolation",
                     PixelGatherOptions().rays))
      ->group("Picture");
}

void addVisibleOnlyOption(CLI::App& app, Request& r) {
  app.add_flag("--visible-only", r.visible_only,
               "A lit mesh has elements where the camera sees it; elsewhere what the patches have")
      ->group("Elements");
}

/// Options that choose the drawn quantity of the matrix's stages, and its colours.
void addShowOptions(CLI::App& app, Request& r) {
  addCreaseOption(app, r);
  add(app, "Picture", "--show", r.show, "QUANTITY",
      fmt::format(
          "False colour with a legend: radiosity or irradiance (W/m^2, Rec. 709 luminance weights "
          "{} R + {} G + {} B), form-factor:PATCH (F from patch number PATCH, from 0, to each "
          "patch), row-sum (how much of each patch's view ends on fronts)",
          kLuminanceOfRed, kLuminanceOfGreen, kLuminanceOfBlue));
}

void addGeneralOptions(CLI::App& app, Request& r, Command command) {
  if (command != Command::info) {
    add(app, "General", "-o,--output", r.outputs, "FILE",
        "File to write, by extension (below). May be repeated");
  }
  add(app, "General", "--threads", r.threads, "N",
      "Threads (default 0: all cores); results do not depend on it, to the bit")
      ->check(wholeNumber());
  app.add_option_function<std::string>(
         "--time-limit",
         [&r](const std::string& text) { r.time_limit = parseDuration("--time-limit", text); },
         "Stop the run after this long, keeping finished stages and rows (--resume); refuse form "
         "factors that are foreseen to take longer than what is left. Seconds, or 90s, 10m, 2h")
      ->option_text("TIME")
      ->group("General");
  add(app, "General", "--max-image", r.scene.max_image, "MEGAPIXELS",
      fmt::format("Largest image that is read, in millions of pixels (default {:g}: 8K textures; 1 "
                  "takes up to 30 MB while it is read)",
                  SceneOptions().max_image));
  add(app, "General", "--report", r.report, "FILE.json",
      "Write every figure of the run, machine-readable");
  app.add_flag("--quiet", r.quiet, "Print errors and loud warnings only")->group("General");
}

CLI::App* addCommand(CLI::App& app, Request& r, Command command) {
  CLI::App* sub = app.add_subcommand(commandName(command), descriptionOf(command));
  sub->footer(examplesOf(command));
  const bool compares = command == Command::compare;
  sub->add_option(compares ? "A" : "SCENE", r.input,
                  compares ? "The reference: results file, lit mesh or picture"
                           : "Scene (.obj, .gltf, .glb, .stl) or results file (.h5)")
      ->required()
      ->option_text(" ");
  if (compares) addCompareOptions(*sub, r);
  addGeneralOptions(*sub, r, command);
  addSceneOptions(*sub, r);
  if (command == Command::info) return sub;
  addMeshOptions(*sub, r);
  if (command == Command::mesh) return sub;
  if (command == Command::gather) {
    addGatherOptions(*sub, r);
    addEyeOptions(*sub, r);
    addCameraOptions(*sub, r);
    addRenderOptions(*sub, r);
    return sub;
  }
  addFactorOptions(*sub, r);
  if (command == Command::factors) return sub;
  addSolveOptions(*sub, r);
  if (compares) {
    addGatherOptions(*sub, r);
    bindToGather(*sub);
  }
  if (compares || command == Command::render) addCameraOptions(*sub, r);
  if (command == Command::view) addCameraOption(*sub, r);
  if (!compares) addElementOptions(*sub, r);
  if (command == Command::solve || command == Command::render) addLightmapOptions(*sub, r);
  if (command == Command::render) {
    addFinalGatherOption(*sub, r);
    addVisibleOnlyOption(*sub, r);
    addRenderOptions(*sub, r);
    addShowOptions(*sub, r);
  }
  if (command == Command::view) {
    addExposureOption(*sub, r, "The page first shows");
    addCreaseOption(*sub, r);
  }
  return sub;
}

/// CLI11 says "A subcommand is required" for a typo in one; say what was typed and what was meant.
void checkCommandWord(int argc, char** argv) {
  std::array<std::string, kCommands.size()> names;
  std::transform(kCommands.begin(), kCommands.end(), names.begin(), commandName);
  const std::string list = "info, mesh, factors, solve, gather, compare, render or view";
  if (argc < 2) {
    throw InputError(
        fmt::format("a subcommand is missing: {}; e.g. radiosity render SCENE -o "
                    "picture.png, or radiosity --help",
                    list));
  }
  const std::string word = argv[1];
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  if (word == "--help" || word == "-h" || word == "--version") return;
  if (word.starts_with('-')) {
    throw InputError(fmt::format("{}: options go after the subcommand ({})", word, list));
  }
  std::error_code ignored;
  if (std::filesystem::exists(word, ignored)) {
    throw InputError(fmt::format("{}: say what to do with it: radiosity {} {}", word, "render",
                                 word + " -o picture.png"));
  }
  throw InputError(
      fmt::format("'{}' is not a subcommand: {}{}", word, list, suggestion(word, names)));
}

/// The one line for what CLI11 found.
std::string explain(const CLI::ParseError& error, const CLI::App& sub) {
  const std::string command = "radiosity " + sub.get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> extras = sub.remaining();
    const std::string word = extras.empty() ? std::string() : extras.front();
    if (!word.starts_with('-')) {
      return fmt::format("unexpected argument '{}': {} takes one scene; outputs are named with -o",
                         word, command);
    }
    std::vector<std::string> names;
    for (const CLI::Option* option : sub.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const std::string flag = word.substr(0, word.find('='));
    std::string meant = suggestion(flag, names);
    for (const std::string& name : names) {
      // "--tolerance" where it is called "--gather-tolerance".
      if (meant.empty() && name.ends_with(flag.substr(1))) meant = "; did you mean " + name + "?";
    }
    return fmt::format("unknown option {}{}; see {} --help", flag, meant, command);
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (sub.get_name() == commandName(Command::compare)) {
      return "compare: A and B are missing: radiosity compare A B, or radiosity compare A --gather";
    }
    return fmt::format("{}: the scene (.obj, .gltf, .glb, .stl) or results file (.h5) is missing",
                       command);
  }
  std::string message = oneLine(error.what());
  const std::string not_converted = "Could not convert: ";
  if (message.starts_with(not_converted)) {
    message = message.substr(not_converted.size()) + " is not a value it takes";
  }
  return fmt::format("{}; see {} --help", message, command);
}

}  // namespace

std::optional<int> parseCommandLine(int argc, char** argv, Request& request) {
  checkCommandWord(argc, argv);
  CLI::App app(
      "radiosity: light a scene by the matrix method. Scene -> patches -> form factors\n"
      "-> radiosity -> picture; each subcommand runs the stages that are missing, up to its own.");
  app.name("radiosity");
  app.set_version_flag("--version", "radiosity " RADIOSITY_VERSION);
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Exit codes: 0 done; 1 the run failed or did not converge; 2 bad input or arguments.\n"
      "Help on one: radiosity render --help\n\n"
      "Example:\n"
      "  radiosity render data/cornell-box.obj -o cornell.png");
  std::array<CLI::App*, kCommands.size()> subs{};
  std::transform(kCommands.begin(), kCommands.end(), subs.begin(),
                 [&](Command command) { return addCommand(app, request, command); });
  request.arguments.assign(argv, argv + argc);
  const auto chosen = [&]() {
    for (std::size_t k = 0; k < subs.size(); ++k) {
      if (argv[1] == std::string(commandName(kCommands[k]))) return k;
    }
    return std::size_t(0);
  }();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw InputError(explain(error, *subs[chosen]));
  }
  request.command = kCommands[chosen];
  return std::nullopt;
}

}  // namespace radiosity::cli
