// Two matrices of form factors, row for row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "radiosity/matrix_files.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

struct Sums {
  std::size_t rows = 0;
  double squares = 0;     ///< sum A_i A_ij^2
  double difference = 0;  ///< sum A_i (B_ij - A_ij)^2
  double largest = 0;

  double relative() const {
    if (difference == 0) return 0;
    return std::sqrt(difference / squares);  // infinite where A is 0
  }
};

MatrixAccount accountOf(const MatrixFile& file) {
  const std::vector<double> sums = file.factors.matrix->rowSums();
  const std::span<const double> area = file.factors.matrix->area();
  MatrixAccount account;
  account.least_sum = INFINITY;
  double total = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!(area[i] > 0)) continue;
    account.least_sum = std::min(account.least_sum, sums[i]);
    account.largest_sum = std::max(account.largest_sum, sums[i]);
    account.mean_sum += area[i] * sums[i];
    total += area[i];
  }
  account.mean_sum = total > 0 ? account.mean_sum / total : 0.0;
  if (file.has_areas) account.reciprocity = reciprocityResidual(*file.factors.matrix);
  return account;
}

double largestAreaDifference(const MatrixFile& a, const MatrixFile& b) {
  if (!a.has_areas || !b.has_areas) return 0;
  double largest = 0;
  for (std::size_t i = 0; i < a.factors.size(); ++i) {
    const double one = a.factors.matrix->area()[i];
    const double other = b.factors.matrix->area()[i];
    if (one != other) largest = std::max(largest, std::abs(one - other) / std::max(one, other));
  }
  return largest;
}

/// The first row that has a name in both and not the same.
std::optional<std::size_t> renamedRow(const MatrixFile& a, const MatrixFile& b) {
  for (std::size_t i = 0; i < a.factors.size(); ++i) {
    const std::string& one = a.factors.names[i];
    const std::string& other = b.factors.names[i];
    if (!one.empty() && !other.empty() && one != other) return i;
  }
  return std::nullopt;
}

/// Calls visit(column, a, b) over the columns in which a row of either has a value.
template <class Visit>
void forBoth(const RowPanel& a, const RowPanel& b, std::size_t i, std::vector<double>& row,
             Visit&& visit) {
  a.forRow(i, [&](Index j, double value) { row[j] = value; });
  b.forRow(i, [&](Index j, double value) {
    visit(j, row[j], value);
    row[j] = 0;
  });
  a.forRow(i, [&](Index j, double value) {
    if (row[j] != 0) visit(j, value, 0.0);
    row[j] = 0;
  });
}

class Comparison {
 public:
  Comparison(const MatrixFile& a, const MatrixFile& b)
      : a_(a), b_(b), names_(hasNames(a) ? a.factors.names : b.factors.names) {
    result_.weighted = a.has_areas || b.has_areas;
    area_ = (a.has_areas ? a : b).factors.matrix->area();
  }

  MatrixComparison run(Progress& progress) {
    std::vector<double> row(area_.size(), 0.0);
    progress.begin("comparing form factors", area_.size());
    a_.factors.matrix->forPanels([&](const RowPanel& rows) {
      const RowPanel others(*b_.factors.matrix, rows.first(), rows.last());
      for (std::size_t i = rows.first(); i < rows.last(); ++i) {
        progress.check();
        Sums& of_name = of_names_[names_[i]];
        ++of_name.rows;
        forBoth(rows, others, i, row,
                [&](Index j, double one, double other) { add(of_name, i, j, one, other); });
        progress.advance();
      }
    });
    progress.end();
    return finished();
  }

 private:
  static bool hasNames(const MatrixFile& file) {
    return std::any_of(file.factors.names.begin(), file.factors.names.end(),
                       [](const std::string& name) { return !name.empty(); });
  }

  void add(Sums& of_name, std::size_t i, std::size_t j, double one, double other) {
    const double difference = std::abs(other - one);
    for (Sums* sums : {&all_, &of_name}) {
      sums->squares += area_[i] * one * one;
      sums->difference += area_[i] * difference * difference;
      sums->largest = std::max(sums->largest, difference);
    }
    if (difference <= result_.largest) return;
    result_.largest = difference;
    result_.row = i;
    result_.column = j;
    result_.a = one;
    result_.b = other;
  }

  MatrixComparison finished() {
    result_.relative_l2 = all_.relative();
    result_.area_difference = largestAreaDifference(a_, b_);
    result_.account_a = accountOf(a_);
    result_.account_b = accountOf(b_);
    if (of_names_.size() == 1 && of_names_.begin()->first.empty()) return std::move(result_);
    std::vector<std::pair<double, MatrixComparison::OfName>> names;
    names.reserve(of_names_.size());
    for (const auto& [name, sums] : of_names_) {
      names.push_back({sums.difference, {name, sums.rows, sums.relative(), sums.largest}});
    }
    std::stable_sort(names.begin(), names.end(),
                     [](const auto& x, const auto& y) { return x.first > y.first; });
    result_.names.reserve(names.size());
    for (auto& [share, name] : names) result_.names.push_back(std::move(name));
    return std::move(result_);
  }

  const MatrixFile& a_;
  const MatrixFile& b_;
  const std::vector<std::string>& names_;
  std::span<const double> area_;
  Sums all_;
  std::map<std::string, Sums> of_names_;
  MatrixComparison result_;
};

}  // namespace

MatrixComparison compareMatrices(const MatrixFile& a, const MatrixFile& b, Progress& progress) {
  if (a.factors.size() != b.factors.size()) {
    throw InputError(fmt::format(
        "{} has {} rows, {} has {}: matrices are compared row for row; make both of the same "
        "patches (a results file as input keeps them)",
        a.path, a.factors.size(), b.path, b.factors.size()));
  }
  MatrixComparison comparison = Comparison(a, b).run(progress);
  comparison.renamed_row = renamedRow(a, b);
  return comparison;
}

}  // namespace radiosity
