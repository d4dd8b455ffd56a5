#include "cli/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/words.h"
#include "radiosity/names.h"
#include "radiosity/tables.h"

namespace radiosity::cli {

namespace {

/// The width of a table on the terminal.
constexpr std::size_t kTerminalWidth = 120;
constexpr std::size_t kTerminalRows = 40;
/// Digits on the terminal; files have all.
constexpr int kTerminalDigits = 4;

constexpr std::array kTables = {Format::csv,    Format::json_table, Format::markdown, Format::idf,
                                Format::view3d, Format::triplets,   Format::hdf5};

/// True for formats of programs that read the matrix itself.
bool isOfPatches(Format format) {
  return format == Format::triplets || format == Format::hdf5 || format == Format::matrix_market;
}

bool printsTable(const Request& request) {
  return !request.between.empty() || !request.groups.empty();
}

/// The value of --between, or else the format's default.
std::string betweenOf(const Request& request, Format format) {
  if (!request.between.empty()) return request.between;
  return isOfPatches(format) ? "patches" : "groups";
}

/// The number of nodes; 0: it is a word.
std::size_t nodesOf(const std::string& between) {
  return std::size_t(std::strtoul(between.c_str(), nullptr, 10));
}

std::vector<std::string> groupsOf(const Request& request, const std::string& between) {
  return between == "surfaces" ? std::vector<std::string>() : request.groups;
}

/// The tables of one run; each is made once.
class Tables {
 public:
  Tables(Session& session, Pipeline& pipeline) : session_(session), pipeline_(pipeline) {
    pipeline.loadMatrix();
  }

  const NamedFactors& get(const std::string& between) {
    std::optional<NamedFactors>& made = between == "patches" ? patches_ : summed_;
    if (!made) {
      made = make(between);
      made->sky_name = session_.request.sky_name;
    }
    return *made;
  }

  const NamedFactors& of(Format format) { return get(betweenOf(session_.request, format)); }

  std::vector<double> emissivity(const NamedFactors& factors) {
    return emissivities(factors, pipeline_.mesh().mesh, pipeline_.materials());
  }

 private:
  NamedFactors make(const std::string& between) {
    const PatchMesh& mesh = pipeline_.mesh().mesh;
    const FormFactors& factors = pipeline_.factors();
    if (between == "patches") return factorsOfPatches(mesh, factors);
    if (const std::size_t nodes = nodesOf(between); nodes > 0) {
      return factorsBetweenNodes(mesh, factors, nodes, session_.progress);
    }
    const SurfaceGroups groups =
        groupSurfaces(mesh.surface_names, groupsOf(session_.request, between));
    session_.report.notes(groups.notes);
    return factorsBetween(mesh, factors, groups, session_.progress);
  }

  Session& session_;
  Pipeline& pipeline_;
  std::optional<NamedFactors>
      summed_;  ///< over groups, surfaces or nodes: one run has one of these
  std::optional<NamedFactors> patches_;
};

TableLayout layoutOf(const Request& request) {
  return named(kTableLayoutNames, request.layout).value_or(TableLayout::wide);
}

/// Records pairs in the report file.
void recordPairs(Report& report, const NamedFactors& factors) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](std::size_t a, const std::string& to, double value, double error) {
    rows.push_back({factors.names[a], to, fmt::format("{}", value), fmt::format("{}", error)});
  };
  for (std::size_t a = 0; a < factors.size(); ++a) {
    for (std::size_t b = 0; b < factors.size(); ++b) {
      add(a, factors.names[b], factors.matrix->at(a, b), factors.entryError(a, b));
    }
    add(a, factors.sky_name, factors.sky[a], std::nan(""));
    add(a, "backs", factors.backs[a], std::nan(""));
  }
  report.mute(true);
  report.table(
      "pairs",
      {{"from", "from", false}, {"to", "to", false}, {"form_factor", "F"}, {"error", "error"}},
      rows);
  report.mute(false);
}

void print(Session& session, const NamedFactors& factors, const std::string& between) {
  Report& report = session.report;
  const std::string rows = between == "patches"   ? "patches"
                           : nodesOf(between) > 0 ? "nodes"
                                                  : "surfaces";
  report.section("table", fmt::format("Form factors between {}, from row to column", rows));
  if (!factors.numbered && !session.request.report.empty()) recordPairs(report, factors);
  double residual = 0;
  for (std::size_t a = 0; !factors.numbered && a < factors.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      residual = std::max(residual, factors.reciprocityResidual(a, b));
    }
  }
  if (!report.muted()) {
    const bool long_rows = layoutOf(session.request) == TableLayout::long_rows || factors.numbered;
    std::string text =
        long_rows ? ""
                  : factorsMarkdown(factors, TableLayout::wide, kTerminalDigits, kTerminalRows);
    if (long_rows || (session.request.layout.empty() && text.find('\n') > kTerminalWidth)) {
      text = factorsMarkdown(factors, TableLayout::long_rows, kTerminalDigits, kTerminalRows);
    }
    std::fputs(("\n" + text + "\n").c_str(), stdout);
  }
  if (!factors.numbered) {
    report.number("reciprocity_m2", "largest |A_a F_ab - A_b F_ba|", residual, "m^2");
  }
  if (!factors.error.empty()) {
    report.text(
        "error_is", "error",
        "of a row: bound on its 2-norm, of a pair (long): on F; both from the rows' figures");
  }
}

std::string zoneOf(const Session& session) {
  if (!session.request.zone.empty()) return session.request.zone;
  return std::filesystem::path(session.request.input).stem().string();
}

void writeTable(Session& session, Tables& tables, Format format, OutputSet& files) {
  if (!files.has(format)) return;
  const NamedFactors& factors = tables.of(format);
  const TableLayout layout = layoutOf(session.request);
  Progress& progress = session.progress;
  const bool are_nodes = nodesOf(session.request.between) > 0;
  const std::string row = factors.numbered ? "patch" : are_nodes ? "node" : "surface";
  const std::string what =
      fmt::format("form factors between {}",
                  plural(factors.size(), row, row + (factors.numbered ? "es" : "s")));
  const auto write = [&](const std::string& text, auto&& writer) {
    files.write(format, what + text, writer);
  };
  using Path = const std::string&;
  switch (format) {
    case Format::csv:
      return write("", [&](Path path) { writeFactorsCsv(path, factors, layout, progress); });
    case Format::json_table:
      return write("", [&](Path path) { writeFactorsJson(path, factors, layout, progress); });
    case Format::markdown:
      return write("", [&](Path path) { writeFactorsMarkdown(path, factors, layout); });
    case Format::idf:
      return write(", EnergyPlus, zone " + zoneOf(session),
                   [&](Path path) { writeEnergyPlus(path, factors, zoneOf(session), progress); });
    case Format::view3d:
      return write(", View3D", [&](Path path) {
        writeView3d(path, factors, tables.emissivity(factors), progress);
      });
    case Format::triplets:
      return write(", triplets numbered from 0",
                   [&](Path path) { writeTriplets(path, factors, progress); });
    default:
      return write(", HDF5, numbered from 0",
                   [&](Path path) { writeTripletsHdf5(path, factors, progress); });
  }
}

/// Notes the light that an open scene loses: EnergyPlus assumes that a zone is closed.
void noteOpenZone(Session& session, const NamedFactors& factors) {
  double lost = 0;
  std::size_t worst = 0;
  for (std::size_t a = 0; a < factors.size(); ++a) {
    const double rest = factors.sky[a] + factors.backs[a];
    if (rest > lost) worst = a;
    lost = std::max(lost, rest);
  }
  if (lost < 1e-3) return;
  const Note note{
      Severity::warning,
      fmt::format("EnergyPlus takes the zone to be closed, but {} of what leaves {} goes "
                  "to the sky or to black backs: close the scene, or it is missing",
                  numberText(lost, 3), factors.names[worst])};
  session.report.notes({&note, 1});
}

}  // namespace

void checkTableOptions(const Request& request, const OutputSet& files) {
  const bool any =
      printsTable(request) ||
      std::any_of(kTables.begin(), kTables.end(), [&](Format format) { return files.has(format); });
  const auto require = [](bool used, bool given, const char* option, const char* cure) {
    if (given && !used) throw InputError(fmt::format("{}: {}, or leave it out", option, cure));
  };
  require(any, !request.layout.empty(), "--layout",
          "is about tables; add --between or a table to write (-o FILE.csv)");
  require(any, request.sky_name != Request().sky_name, "--sky-name",
          "is about tables; add --between or a table to write (-o FILE.csv)");
  require(files.has(Format::idf), !request.zone.empty(), "--zone",
          "is about EnergyPlus; name a file for it (-o FILE.idf)");
  require(request.between.empty() || request.between == "groups", !request.groups.empty(),
          "--group", "joins surfaces, and --between asks for others; use --between groups");
}

void checkTables(const Session& session, const OutputSet& files,
                 std::span<const std::string> surfaces, std::size_t patches) {
  const Request& request = session.request;
  const auto rowsOf = [&](const std::string& between) {
    NamedFactors rows;
    rows.numbered = between == "patches";
    rows.sky_name = request.sky_name;
    if (rows.numbered) {
      rows.names.resize(patches);
    } else if (nodesOf(between) == 0) {
      rows.names = groupSurfaces(surfaces, groupsOf(request, between)).names;
    }
    return rows;
  };
  groupSurfaces(surfaces, request.groups);
  for (const Output& output : files.all()) {
    const auto rows = [&] { return rowsOf(betweenOf(request, output.format)); };
    if (output.format == Format::csv || output.format == Format::json_table) {
      checkTableRows(output.path, rows(), layoutOf(request));
    } else if (output.format == Format::markdown) {
      checkTableRows(output.path, rows(), TableLayout::wide);
    } else if (output.format == Format::idf) {
      checkEnergyPlusRows(output.path, rows(), zoneOf(session));
    } else if (output.format == Format::view3d) {
      checkView3dRows(output.path, rows());
    }
  }
  if (printsTable(request)) {
    checkTableRows("table", rowsOf(request.between), TableLayout::long_rows);
  }
}

void writeTables(Session& session, Pipeline& pipeline, OutputSet& files) {
  const Request& request = session.request;
  const bool writes =
      std::any_of(kTables.begin(), kTables.end(), [&](Format format) { return files.has(format); });
  const bool lists = files.has(Format::matrix_market);
  if (!writes && !lists && !printsTable(request)) return;
  Tables tables(session, pipeline);
  if (printsTable(request)) {
    const std::string between = request.between.empty() ? "groups" : request.between;
    print(session, tables.get(between), between);
  }
  for (const Format format : kTables) writeTable(session, tables, format, files);
  if (lists) writeMatrix(session, tables.of(Format::matrix_market), files);
  if (files.has(Format::idf)) noteOpenZone(session, tables.of(Format::idf));
}

}  // namespace radiosity::cli
