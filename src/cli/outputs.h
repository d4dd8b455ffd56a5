// The output files of a run: the extension tells the format, and either all are written or none.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "cli/report.h"
#include "cli/request.h"
#include "radiosity/base.h"

namespace radiosity::cli {

enum class Format {
  results,
  matrix_market,
  png,
  exr,
  hdr,
  glb,
  obj,
  vtp,
  csv,
  light_csv,
  json_table,
  markdown,
  idf,
  view3d,
  triplets,
  hdf5,
  page,
  mitsuba,
  pbrt,
  beside,
  lightmap,
  illuminance,
  surface_table,
  patch_table,
  point_table
};

struct Output {
  std::string path;
  Format format;
};

/// The files of -o for this subcommand, and those of --lightmap and tables. Errors:
/// InputError for an extension that it cannot write (with the list of those that it can), the same
/// file twice, the scene file itself, or an HDF5 file of another program in place of results.
std::vector<Output> parseOutputs(const Request& request);

/// Checks, once the scene is read, that no output would replace a file that belongs to it, such as
/// a texture. Errors: InputError naming the output.
void requireNoFileOfScene(const Request& request);

/// Writes files under temporary names; commit() renames all. Without commit() all are removed.
class OutputSet {
 public:
  /// Claims every path at once, so that a missing folder is found before any work is done.
  explicit OutputSet(std::vector<Output> outputs);

  const std::vector<Output>& all() const { return outputs_; }
  bool has(Format format) const;
  /// The first path of that format; empty if there is none.
  std::string path(Format format) const;
  /// Claims one more file, for instance the results file of the input; does nothing if it is
  /// claimed already.
  void add(Output output);

  /// Calls writer(temporary path) for every output of that format; `what` describes it.
  void write(Format format, const std::string& what,
             const std::function<void(const std::string&)>& writer);
  /// Claims and writes a file that belongs to an output and has a name made from that output's.
  void writeBeside(const std::string& path, const std::string& what,
                   const std::function<void(const std::string&)>& writer);
  /// Renames the written files and lists them in the report.
  void commit(Report& report, const Progress& progress);

 private:
  struct File {
    std::unique_ptr<AtomicFile> file;
    std::string what;
    bool written = false;
  };
  void writeFile(std::size_t k, const std::string& what,
                 const std::function<void(const std::string&)>& writer);

  std::vector<Output> outputs_;
  std::vector<File> files_;
};

/// Throws RunError, with both numbers, if the folder's disk has less than `bytes` free.
void requireDiskSpace(const std::string& path, std::size_t bytes);

}  // namespace radiosity::cli
