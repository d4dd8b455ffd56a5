#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "base/file_name.h"
#include "base/input_file.h"
#include "base/made.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/results.h"
#include "radiosity/spelling.h"
#include "results/matrix_market.h"
#include "scene/text.h"
#include "tables/matrix_readers.h"
#include "tables/row_comments.h"

namespace radiosity {

namespace {

/// A share of the sky below this counts as 0: text in six digits leaves as much.
constexpr double kClosedWithin = 1e-5;
/// The largest reciprocity residual without a warning: coarse hemicubes reach a few percent.
constexpr double kMostUneven = 0.05;

bool isClosed(std::span<const double> sky) {
  return std::all_of(sky.begin(), sky.end(), [](double s) { return std::abs(s) < kClosedWithin; });
}

void noteSums(FormFactors& factors) {
  const auto largest = std::max_element(factors.fronts.begin(), factors.fronts.end());
  if (largest == factors.fronts.end() || *largest <= kMostRowSum) return;
  const auto above = std::count_if(factors.fronts.begin(), factors.fronts.end(),
                                   [](double sum) { return sum > kMostRowSum; });
  factors.report.notes.push_back(
      {Severity::loud,
       fmt::format(
           "row {} sums to {:.6g}{}: form factors sum to 1 at most, and such rows create light",
           largest - factors.fronts.begin() + 1, *largest,
           above > 1 ? fmt::format(" ({} rows are above 1)", above) : "")});
}

void noteReciprocity(FormFactors& factors) {
  const double residual = reciprocityResidual(pairsOf(*factors.matrix));
  factors.report.reciprocity_residual = residual;
  if (residual <= kMostUneven) return;
  factors.report.notes.push_back(
      {Severity::warning, fmt::format("A_i F_ij and A_j F_ji differ by {:.0f}%: energies will not "
                                      "balance; are the areas those of the rows?",
                                      100 * residual)});
}

std::string firstLine(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line(64, '\0');
  file.read(line.data(), std::streamsize(line.size()));
  line.resize(std::size_t(file.gcount()));
  return line.substr(0, line.find_first_of("\r\n"));
}

/// Refuses a file whose start fits none of the formats; its name tells the intended one.
[[noreturn]] void refuseStart(const std::string& path) {
  const std::string extension = lowerExtension(path);
  const std::string why =
      extension == ".mtx"
          ? fmt::format("it does not begin with {}; write it again", kMatrixMarketMark)
      : extension == ".vf" ? "it does not begin as View3D's do (program, version, 0, 0 or 1, 0, "
                             "rows); write it again"
                           : "what is read: results (.h5), MatrixMarket (.mtx), View3D (.vf)";
  throw InputError(fmt::format("{}: is no matrix of form factors; {}", path, why));
}

MatrixFile readOfResults(const std::string& path) {
  const Results results = readResults(path);
  if (!results.mesh || !results.factors) {
    throw InputError(path + ": holds no form factors; run radiosity factors on it");
  }
  MatrixFile file;
  file.path = path;
  file.factors = factorsOfPatches(made(results.mesh).mesh, made(results.factors));
  return file;
}

}  // namespace

void setDefaultAccounts(NamedFactors& factors) {
  const std::vector<double> sums = factors.matrix->rowSums();
  const std::size_t n = sums.size();
  factors.backs.assign(n, 0.0);
  factors.sky.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    factors.sky[i] = factors.matrix->area()[i] > 0 ? std::max(0.0, 1 - sums[i]) : 0.0;
  }
}

std::vector<double> chosenAreas(const std::string& path, std::span<const double> area,
                                std::vector<double> of_file) {
  if (area.empty()) return of_file;
  if (area.size() != of_file.size()) {
    throw InputError(fmt::format("{}: has {} rows, and {} areas are given; give one a row", path,
                                 of_file.size(), area.size()));
  }
  return {area.begin(), area.end()};
}

bool isMatrixFile(const std::string& path) {
  if (!whyNotAFile(path).empty()) return false;
  const std::string line = firstLine(path);
  return line.starts_with(kMatrixMarketMark) || parseView3dHeader(line).has_value();
}

MatrixFile readMatrixFile(const std::string& path, Progress& progress,
                          std::span<const double> areas) {
  requireFile(path);
  MatrixFile file;
  if (isResultsFile(path)) {
    if (!areas.empty()) {
      throw InputError(fmt::format("{}: a results file has areas of its own; leave {} out", path,
                                   spelled("areas")));
    }
    return readOfResults(path);
  }
  const std::string line = firstLine(path);
  if (line.starts_with(kMatrixMarketMark)) {
    file = readMatrixMarket(path, areas, progress);
  } else if (parseView3dHeader(line)) {
    file = readView3d(path, areas);
  } else {
    refuseStart(path);
  }
  NamedFactors& factors = file.factors;
  file.path = path;
  factors.numbered = true;
  factors.members.assign(factors.size(), 1);
  factors.row_of.resize(factors.size());
  std::iota(factors.row_of.begin(), factors.row_of.end(), Index(0));
  if (!file.has_accounts) setDefaultAccounts(factors);
  factors.closed = isClosed(factors.sky);
  return file;
}

void writeMatrixMarket(const std::string& path, const NamedFactors& factors, Progress& progress) {
  writeMatrixMarket(
      path, *factors.matrix, [&](std::size_t i) { return rowComment(factors, i); }, progress);
}

FormFactors factorsOfMatrix(std::shared_ptr<const ExchangeMatrix> matrix, std::vector<double> sky,
                            std::vector<double> backs, bool has_areas) {
  FormFactors factors;
  factors.fronts = matrix->rowSums();
  factors.matrix = std::move(matrix);
  factors.sky = std::move(sky);
  factors.backs = std::move(backs);
  factors.report.closed = isClosed(factors.sky);
  factors.method = FormFactorMethod::matrix;
  noteSums(factors);
  if (has_areas) noteReciprocity(factors);
  return factors;
}

FormFactors factorsOfFile(const MatrixFile& file) {
  FormFactors factors =
      factorsOfMatrix(file.factors.matrix, file.factors.sky, file.factors.backs, file.has_areas);
  factors.error = file.factors.error;
  factors.method = FormFactorMethod::file;
  return factors;
}

}  // namespace radiosity
