// The command line: options, help, and messages for wrong arguments.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "cli/command_texts.h"
#include "cli/help_formatter.h"
#include "cli/manuals.h"
#include "cli/options.h"
#include "cli/request.h"
#include "cli/self_test.h"
#include "cli/validators.h"
#include "cli/words.h"
#include "radiosity/compare.h"
#include "radiosity/names.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

constexpr std::array kCommands = {
    Command::info, Command::mesh,    Command::factors, Command::solve,       Command::gather,
    Command::heat, Command::compare, Command::render,  Command::illuminance, Command::view};

void addCompareOptions(CLI::App& app, Request& r) {
  app.add_option("B", r.second, "The file to compare with A; none with --gather")->option_text(" ");
  app.add_flag(
         "--gather", r.with_gather,
         "Compare the matrix solution of A with the gather method, running missing stages first")
      ->group("Compare");
  for (const auto& [name, value] : {std::pair("--a-is", &r.a_is), std::pair("--b-is", &r.b_is)}) {
    add(app, "Compare", name, *value, "radiosity|radiance|srgb8",
        "What the numbers of the file mean: W/m^2, W/m^2/sr, or coded for a screen (default: as "
        "the file says; where it does not, this is needed)")
        ->check(CLI::IsMember(namesIn(kLightUnitNames)));
  }
  addOptionsOf<CompareOptions>(app, r, "Compare");
  app.add_flag("--form-factors", r.compare_factors,
               "Compare the form factors of results files, not their light; files of form factors "
               "alone (.mtx, .vf) need no option")
      ->group("Compare");
  addAreasOption(app, r, "Compare");
  add(app, "Compare", "--tolerance", r.compare_tolerance, "RATIO",
      "Exit with 1 where the relative L2 difference is above it (default: exit with 0)")
      ->check(nonNegative());
}

/// Binds options to --gather, which makes both sides: without it two files are compared as they
/// are.
void bindToGather(CLI::App& app) {
  CLI::Option* gather = app.get_option("--gather");
  for (const char* name : {"--a-is", "--b-is"}) app.get_option(name)->excludes(gather);
  for (CLI::Option* option : app.get_options()) {
    const std::string& group = option->get_group();
    if (group != "General" && group != "Compare" && group != "Picture" && !option->get_positional())
      option->needs(gather);
  }
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
  add(app, "General", "--report", r.report, "FILE.json",
      "Write every figure of the run, machine-readable");
  app.add_flag("--quiet", r.quiet, "Print errors and loud warnings only")->group("General");
}

/// Adds --devices, which needs no scene.
void addDevicesFlag(CLI::App& app, Request& r, CLI::Option& scene) {
  app.add_flag("--devices", r.devices, "List the devices that can draw hemicubes (--eye gl)")
      ->group("General")
      ->excludes(&scene);
  app.callback([&r, &scene] {
    if (!r.devices && scene.count() == 0) throw CLI::RequiredError(scene.get_name());
  });
}

CLI::App* addCommand(CLI::App& app, Request& r, Command command) {
  CLI::App* sub = app.add_subcommand(commandName(command), descriptionOf(command));
  sub->footer(examplesOf(command));
  const bool compares = command == Command::compare;
  CLI::Option* input =
      sub->add_option(compares ? "A" : "SCENE", r.input,
                      compares ? "The reference: results file, lit mesh or picture"
                               : fmt::format("Scene ({}) or results file (.h5)", sceneExtensions()))
          ->option_text(" ");
  if (command == Command::info) {
    addDevicesFlag(*sub, r, *input);
  } else {
    input->required();
  }
  if (compares) addCompareOptions(*sub, r);
  addGeneralOptions(*sub, r, command);
  addSceneOptions(*sub, r);
  if (command == Command::info) return sub;
  addMeshOptions(*sub, r);
  if (command == Command::mesh) return sub;
  if (command == Command::gather) {
    addOptionsOf<GatherOptions>(*sub, r, "Gather");
    addCameraOptions(*sub, r);
    addRenderOptions(*sub, r);
    return sub;
  }
  addFactorOptions(*sub, r);
  if (command == Command::factors) {
    addTableOptions(*sub, r);
    return sub;
  }
  if (command == Command::heat) {
    addHeatOptions(*sub, r);
    addPointOptions(*sub, r);
    return sub;
  }
  addOptionsOf<SolveOptions>(*sub, r, "Solve");
  if (command == Command::illuminance) {
    addPointOptions(*sub, r);
    addOptionsOf<IlluminanceOptions>(*sub, r, "Points");
    addRangeOption(*sub, r, "Points");
    return sub;
  }
  if (command == Command::solve) addBasisOption(*sub, r);
  if (command == Command::solve || command == Command::render) addMixOption(*sub, r);
  if (command == Command::solve) addMatrixOptions(*sub, r);
  if (compares) {
    addOptionsOf<GatherOptions>(*sub, r, "Gather");
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
    add(*sub, "Page", "--gallery", r.gallery, "DIR",
        "Write the page into this folder, with a thumbnail, and an index.html of all pages there");
  }
  return sub;
}

/// What is asked of the program itself, without a subcommand.
void addProgramOptions(CLI::App& app) {
  app.set_help_flag("-h", "Tell the names of the options");
  app.set_help_all_flag("--help", "Tell what each option does, its units and its default");
  app.set_version_flag("--version", "radiosity " RADIOSITY_VERSION, "Tell the version");
  app.add_flag_callback(
      "--self-test",
      [] {
        selfTest();
        throw CLI::Success();
      },
      "Compute what has a known answer, in seconds; exit with 1 where this installation is wrong");
  app.add_option_function<std::string>(
         "--manuals",
         [&app](const std::string& folder) {
           writeManuals(app, folder);
           throw CLI::Success();
         },
         "Write manual pages and completions of bash, zsh and fish, in folders as below "
         "PREFIX/share; for you alone: ~/.local/share")
      ->option_text("FOLDER");
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Exit codes: 0 done; 1 the run failed or did not converge; 2 bad input or arguments.\n"
      "Help on one: radiosity help render\n\n"
      "Example:\n"
      "  radiosity render data/cornell-box.obj -o cornell.png");
}

/// Checks the subcommand: for a typo CLI11 only says "A subcommand is required", while we name the
/// word and suggest the right one.
void checkCommandWord(const CLI::App& program, int argc, char** argv) {
  std::array<std::string, kCommands.size()> names;
  std::transform(kCommands.begin(), kCommands.end(), names.begin(), commandName);
  const std::string list =
      "info, mesh, factors, solve, gather, heat, compare, render, illuminance or view";
  if (argc < 2) {
    throw InputError(
        fmt::format("a subcommand is missing: {}; e.g. radiosity render SCENE -o "
                    "picture.png, or radiosity --help",
                    list));
  }
  const std::string word = argv[1];
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  for (const CLI::Option* option : program.get_options()) {
    if (option->check_name(word)) return;
  }
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

/// Prints the help of "help" and "help COMMAND", as --help does, and returns the exit code.
std::optional<int> help(int argc, char** argv, Request& request) {
  std::vector<char*> words(argv, argv + argc);
  words.erase(words.begin() + 1);
  words.resize(std::min<std::size_t>(words.size(), 2));
  std::string option = "--help";
  words.push_back(option.data());
  return parseCommandLine(int(words.size()), words.data(), request);
}

/// The message, in one line, for an error of CLI11.
std::string explain(const CLI::ParseError& error, const CLI::App& sub) {
  const std::string command =
      sub.get_parent() == nullptr ? "radiosity" : "radiosity " + sub.get_name();
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
      // "--tolerance" for an option called "--gather-tolerance".
      if (meant.empty() && name.ends_with(flag.substr(1))) meant = "; did you mean " + name + "?";
    }
    return fmt::format("unknown option {}{}; see {} --help", flag, meant, command);
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (sub.get_name() == commandName(Command::compare)) {
      return "compare: A and B are missing: radiosity compare A B, or radiosity compare A --gather";
    }
    return fmt::format("{}: the scene ({}) or results file (.h5) is missing", command,
                       sceneExtensions());
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
  if (argc > 1 && argv[1] == std::string("help")) return help(argc, argv, request);
  CLI::App app(
      "Light a scene by the matrix method. Scene -> patches -> form factors\n"
      "-> radiosity -> picture; each subcommand runs the stages that are missing, up to its own.");
  app.name("radiosity");
  addProgramOptions(app);
  checkCommandWord(app, argc, argv);
  std::array<CLI::App*, kCommands.size()> subs{};
  std::transform(kCommands.begin(), kCommands.end(), subs.begin(),
                 [&](Command command) { return addCommand(app, request, command); });
  request.arguments.assign(argv, argv + argc);
  const auto chosen = std::size_t(
      std::find_if(kCommands.begin(), kCommands.end(),
                   [&](Command command) { return std::string(argv[1]) == commandName(command); }) -
      kCommands.begin());
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw InputError(explain(error, chosen < subs.size() ? *subs[chosen] : app));
  }
  request.command = kCommands[chosen];
  request.given.applyTo<SceneOverrides>(request.scene);
  request.scene = request.apply(request.scene);
  request.validate();
  return std::nullopt;
}

}  // namespace radiosity::cli
