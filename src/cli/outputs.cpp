#include "cli/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/figure_text.h"
#include "base/file_name.h"
#include "base/input_file.h"
#include "cli/light_mix.h"
#include "cli/words.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace fs = std::filesystem;

namespace {

struct Extension {
  const char* text;
  Format format;
  std::vector<Command> commands;
};

const std::vector<Extension>& extensions() {
  using enum Command;
  static const std::vector<Extension> kAll = {
      {".png", Format::png, {gather, compare, render, illuminance}},
      {".exr", Format::exr, {gather, render}},
      {".hdr", Format::hdr, {gather, render}},
      {".glb", Format::glb, {mesh, solve, gather, render}},
      {".obj", Format::obj, {mesh}},
      {".vtp", Format::vtp, {mesh, factors, solve, heat}},
      {".csv", Format::surface_table, {heat}},
      {".h5",
       Format::results,
       {mesh, factors, solve, gather, heat, compare, render, illuminance, view}},
      {".mtx", Format::matrix_market, {factors, solve, render}},
      {".csv", Format::csv, {factors}},
      {".csv", Format::light_csv, {solve}},
      {".csv", Format::illuminance, {illuminance}},
      {".json", Format::json_table, {factors}},
      {".md", Format::markdown, {factors}},
      {".idf", Format::idf, {factors}},
      {".vf", Format::view3d, {factors}},
      {".txt", Format::triplets, {factors}},
      {".hdf5", Format::hdf5, {factors}},
      {".html", Format::page, {view}},
      {".xml", Format::mitsuba, {render}},
      {".pbrt", Format::pbrt, {render}},
  };
  return kAll;
}

bool contains(const std::vector<Command>& commands, Command command) {
  return std::find(commands.begin(), commands.end(), command) != commands.end();
}

Format formatOf(const std::string& path, Command command) {
  const std::string extension = lowerExtension(path);
  std::string list;
  for (const Extension& known : extensions()) {
    if (!contains(known.commands, command)) continue;
    if (extension == known.text) return known.format;
    list += (list.empty() ? "" : ", ") + std::string(known.text);
  }
  throw InputError(fmt::format("{}: {} writes {}; end the name in one of them", path,
                               commandName(command), list));
}

bool sameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  const auto place = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(fileBehindLinks(path)), ignored);
  };
  return place(a) == place(b) || fs::equivalent(a, b, ignored);
}

/// The map of --lightmap. It must have floats: 8 bits are not enough for W/m^2.
Output lightmapOutput(const std::string& path) {
  if (lowerExtension(path) != ".exr") {
    throw InputError(path + ": --lightmap writes .exr; end the name in it");
  }
  return {path, Format::lightmap};
}

/// The table of --patch-table or --point-table.
Output tableOutput(const std::string& path, const char* option, Format format) {
  if (lowerExtension(path) != ".csv") {
    throw InputError(fmt::format("{}: {} writes .csv; end the name in it", path, option));
  }
  return {path, format};
}

/// A file that the run reads: what it is, and its path.
struct InputPath {
  std::string what;
  std::string path;
};

std::vector<InputPath> inputsOf(const Request& request) {
  const bool basis_file = request.basis != kBasisOfSurfaces;
  std::vector<InputPath> inputs = {{"the input itself", request.input},
                                   {"the second input", request.second},
                                   {"the table of --thermal", request.thermal},
                                   {"the table of --rows", request.rows},
                                   {"the file of --areas", request.areas},
                                   {"the table of --basis", basis_file ? request.basis : ""},
                                   {"the file of --materials", request.scene.materials_file}};
  for (const std::string& path : request.light_lists) {
    inputs.push_back({"the list of --lights", path});
  }
  for (const PointsAsked& asked : request.points) {
    if (asked.kind == PointsAsked::Kind::points) {
      inputs.push_back({"the table of --points", asked.text});
    }
  }
  return inputs;
}

/// A results file may take up what it was made from; no other output may replace a file that an
/// option names.
void requireNoInput(const std::string& path, const Request& request, bool results) {
  for (const InputPath& input : inputsOf(request)) {
    if (input.path.empty() || !sameFile(path, input.path)) continue;
    if (results && input.path == request.input) continue;
    throw InputError(fmt::format("{}: is {}; write to another name", path, input.what));
  }
}

/// The report is written last, over any other file of its name.
void requireOwnReport(const Request& request, const std::vector<Output>& outputs) {
  if (request.report.empty()) return;
  requireNoInput(request.report, request, false);
  for (const Output& output : outputs) {
    if (!sameFile(request.report, output.path)) continue;
    throw InputError(
        fmt::format("{}: is {}, an output, and the file of --report; write to another "
                    "name",
                    request.report, output.path));
  }
}

}  // namespace

std::vector<Output> parseOutputs(const Request& request) {
  std::vector<Output> outputs;
  std::vector<Output> asked;
  asked.reserve(request.outputs.size() + 3);
  for (const std::string& path : request.outputs) {
    asked.push_back({path, formatOf(path, request.command)});
  }
  if (!request.lightmap.empty()) asked.push_back(lightmapOutput(request.lightmap));
  if (!request.patch_table.empty()) {
    asked.push_back(tableOutput(request.patch_table, "--patch-table", Format::patch_table));
  }
  if (!request.point_table.empty()) {
    asked.push_back(tableOutput(request.point_table, "--point-table", Format::point_table));
  }
  for (const Output& output : asked) {
    const std::string& path = output.path;
    for (const Output& other : outputs) {
      if (sameFile(path, other.path))
        throw InputError(path + ": named twice as an output; once is enough");
    }
    requireNoInput(path, request, output.format == Format::results);
    if (output.format == Format::results && isForeignHdf5(path)) {
      throw InputError(
          path +
          ": is an HDF5 file of another program, which results would replace; write to "
          "another name, or delete it");
    }
    outputs.push_back(output);
  }
  requireOwnReport(request, outputs);
  return outputs;
}

void requireNoFileOfScene(const Request& request) {
  std::vector<std::string> paths = {request.lightmap, request.patch_table, request.point_table,
                                    request.report};
  // Results files are looked into for what can be reused, and are no files of scenes.
  std::ranges::copy_if(request.outputs, std::back_inserter(paths), [&](const std::string& path) {
    return formatOf(path, request.command) != Format::results;
  });
  for (const std::string& path : paths) {
    if (path.empty() || sameFile(path, request.input) || !wasFound(path)) continue;
    throw InputError(
        fmt::format("{}: is a file of the scene {}, which it would replace; write to another name",
                    path, request.input));
  }
}

OutputSet::OutputSet(std::vector<Output> outputs) {
  for (Output& output : outputs) add(std::move(output));
}

void OutputSet::add(Output output) {
  for (const Output& have : outputs_) {
    if (sameFile(have.path, output.path)) return;
  }
  files_.push_back({std::make_unique<AtomicFile>(output.path), {}, false});
  outputs_.push_back(std::move(output));
}

bool OutputSet::has(Format format) const { return !path(format).empty(); }

std::string OutputSet::path(Format format) const {
  for (const Output& output : outputs_) {
    if (output.format == format) return output.path;
  }
  return {};
}

void OutputSet::write(Format format, const std::string& what,
                      const std::function<void(const std::string&)>& writer) {
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    if (outputs_[k].format == format) writeFile(k, what, writer);
  }
}

void OutputSet::writeBeside(const std::string& path, const std::string& what,
                            const std::function<void(const std::string&)>& writer) {
  for (const Output& output : outputs_) {
    if (!sameFile(output.path, path)) continue;
    throw InputError(
        fmt::format("{}: is an output, and would be a file beside {}; give one of "
                    "them another name",
                    path, outputs_.front().path));
  }
  if (wasFound(path)) {
    throw InputError(path +
                     ": is a file of the scene, which a file beside the output would replace; "
                     "give the output another name");
  }
  add({path, Format::beside});
  writeFile(files_.size() - 1, what, writer);
}

void OutputSet::writeFile(std::size_t k, const std::string& what,
                          const std::function<void(const std::string&)>& writer) {
  const std::string& temporary = files_[k].file->temporary();
  // A writer only knows the temporary name, so we put the final name into its messages.
  const auto named = [&](std::string message) {
    const std::size_t at = message.find(temporary);
    return at == std::string::npos ? message
                                   : message.replace(at, temporary.size(), outputs_[k].path);
  };
  try {
    writer(temporary);
  } catch (const Cancelled&) {
    throw;
  } catch (const InputError& error) {
    throw InputError(named(error.what()));
  } catch (const RunError& error) {
    throw RunError(named(error.what()));
  }
  files_[k].what = what;
  files_[k].written = true;
}

void OutputSet::commit(Report& report, const Progress& progress) {
  progress.check();
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    if (!files_[k].written) continue;
    files_[k].file->commit();
    std::error_code ignored;
    report.output(outputs_[k].path, fs::file_size(outputs_[k].path, ignored), files_[k].what);
  }
}

void requireDiskSpace(const std::string& path, std::size_t bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(fs::absolute(fileBehindLinks(path)).parent_path(), error);
  if (!error && space.available < bytes) {
    throw RunError(
        fmt::format("{}: needs about {} on disk, {} are free; free some or write elsewhere", path,
                    bytesText(bytes), bytesText(space.available)));
  }
}

}  // namespace radiosity::cli
