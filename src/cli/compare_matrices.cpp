// `compare A B` for form factors.
#include <fmt/format.h>

#include <tuple>

#include "cli/matrix_commands.h"
#include "cli/words.h"

namespace radiosity::cli {

namespace {

/// The largest relative difference of areas of the same patch, in files of six digits.
constexpr double kSameArea = 1e-5;

void requireNothingElse(const Request& request, const OutputSet& files) {
  const std::pair<const char*, bool> of_light[] = {{"--gather", request.with_gather},
                                                   {"--a-is", !request.a_is.empty()},
                                                   {"--b-is", !request.b_is.empty()},
                                                   {"--camera", !request.camera.empty()}};
  std::string given = request.given.firstOf(
      {"fit-scale", "partial", "match", "width", "height", "samples", "backs"});
  for (const auto& [name, is_given] : of_light) {
    if (is_given) given = name;
  }
  if (!given.empty()) {
    throw InputError(given + ": is about light, and A and B are form factors; leave it out");
  }
  if (!files.all().empty()) {
    throw InputError(files.all().front().path +
                     ": a comparison of form factors has no picture; use --report FILE.json");
  }
}

std::string placeOf(const MatrixFile& file, std::size_t i) {
  const std::string& name = file.factors.names[i];
  return name.empty() ? fmt::format("row {}", i + 1) : fmt::format("row {} ({})", i + 1, name);
}

void reportAccount(Report& report, const char* side, const MatrixAccount& account) {
  const std::string key = side == std::string("A") ? "a" : "b";
  report.number(
      "row_sum_" + key, fmt::format("row sums of {}, mean", side), account.mean_sum,
      fmt::format("({} to {})", numberText(account.least_sum), numberText(account.largest_sum)));
  report.mute(true);
  report.number("row_sum_least_" + key, "", account.least_sum);
  report.number("row_sum_largest_" + key, "", account.largest_sum);
  report.mute(false);
  if (account.reciprocity) {
    report.number("reciprocity_" + key, fmt::format("reciprocity residual of {}", side),
                  *account.reciprocity);
  } else {
    report.text("reciprocity_" + key, fmt::format("reciprocity residual of {}", side),
                "none: its areas are not known; give --areas FILE");
  }
}

void reportNames(Report& report, const MatrixComparison& c) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(c.names.size());
  for (const MatrixComparison::OfName& n : c.names) {
    rows.push_back({n.name.empty() ? "(unnamed)" : n.name, fmt::format("{}", n.rows),
                    fmt::format("{:.4g}", n.relative_l2), fmt::format("{:.4g}", n.largest)});
  }
  report.table("rows_by_name",
               {{"name", "rows of", false},
                {"rows", "rows"},
                {"relative_l2", "rel. L2"},
                {"largest", "largest"}},
               rows);
}

void reportMatrixComparison(Report& report, const MatrixComparison& c, const MatrixFile& names) {
  report.section("comparison", "Comparison of form factors");
  report.number("relative_l2", "relative L2 difference", c.relative_l2,
                c.weighted ? "(rows weighted by area)" : "(rows weigh alike: areas are not known)");
  report.number("largest", "largest difference", c.largest);
  report.text("largest_from", "  from (numbered from 1)", placeOf(names, c.row));
  report.text("largest_to", "  to", placeOf(names, c.column));
  report.number("largest_a", "  A there", c.a);
  report.number("largest_b", "  B there", c.b);
  reportAccount(report, "A", c.account_a);
  reportAccount(report, "B", c.account_b);
  report.number("area_difference", "areas differ by at most", c.area_difference, "(relative)");
  reportNames(report, c);
}

/// Warns of what makes the figures mean something else than they seem to.
void reportSuspicions(Report& report, const MatrixComparison& c, const MatrixFile& a,
                      const MatrixFile& b) {
  std::vector<Note> notes;
  if (c.area_difference > kSameArea) {
    notes.push_back({Severity::warning,
                     fmt::format("areas of A and B differ by up to {}: are rows in the same order?",
                                 numberText(c.area_difference, 3))});
  }
  if (c.renamed_row) {
    const std::size_t i = *c.renamed_row;
    notes.push_back({Severity::warning,
                     fmt::format("row {} is {} in A and {} in B: are rows in the same order?",
                                 i + 1, a.factors.names[i], b.factors.names[i])});
  }
  for (const auto& [side, file, account] :
       {std::tuple("A", &a, &c.account_a), std::tuple("B", &b, &c.account_b)}) {
    // Error figures say by how much computed rows may be above 1.
    if (!file->factors.error.empty() || account->largest_sum <= kMostRowSum) continue;
    notes.push_back(
        {Severity::warning, fmt::format("a row of {} sums to {}: form factors sum to 1 at most",
                                        side, numberText(account->largest_sum))});
  }
  report.notes(notes);
}

/// Reads one side. Areas from --areas are only used for files without areas.
MatrixFile readMatrixSide(Session& session, const std::string& path) {
  std::vector<double> areas;
  if (!session.request.areas.empty() && isMatrixInput(path)) {
    areas = readAreas(session.request.areas);
  }
  return readMatrixFile(path, session.progress, areas);
}

}  // namespace

bool comparesMatrices(const Request& request) {
  return request.compare_factors || isMatrixInput(request.input) ||
         (!request.second.empty() && isMatrixInput(request.second));
}

int compareMatrixFiles(Session& session, OutputSet& files) {
  const Request& request = session.request;
  requireNothingElse(request, files);
  if (request.second.empty()) throw InputError("compare: B is missing: radiosity compare A B");
  const MatrixFile a = readMatrixSide(session, request.input);
  const MatrixFile b = readMatrixSide(session, request.second);
  for (const auto& [label, file] : {std::pair("A", &a), std::pair("B", &b)}) {
    session.report.line(label, fmt::format("{}: form factors of {}", file->path,
                                           plural(file->factors.size(), "row", "rows")));
  }
  const MatrixComparison c = compareMatrices(a, b, session.progress);
  const bool a_named = !a.factors.names[c.row].empty();
  reportMatrixComparison(session.report, c, a_named ? a : b);
  reportSuspicions(session.report, c, a, b);
  if (!request.compare_tolerance) return 0;
  const bool within = c.relative_l2 <= *request.compare_tolerance;
  session.report.text("verdict", "verdict",
                      fmt::format("{} the tolerance of {}", within ? "within" : "above",
                                  numberText(*request.compare_tolerance)));
  return within ? 0 : 1;
}

}  // namespace radiosity::cli
