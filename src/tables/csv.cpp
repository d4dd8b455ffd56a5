// Comma-separated values (RFC 4180).
#include "base/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/figure_text.h"
#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

double largestResidual(const NamedFactors& factors, std::size_t a) {
  double largest = 0;
  for (std::size_t b = 0; b < factors.size(); ++b) {
    largest = std::max(largest, factors.reciprocityResidual(a, b));
  }
  return largest;
}

void writeWideCsv(CheckedFile& file, const NamedFactors& factors, Progress& progress) {
  const bool has_error = !factors.error.empty();
  std::string header = "name,area_m2";
  for (std::size_t b = 0; b < factors.size(); ++b) {
    header += fmt::format(",{}", csvField(labelOf(factors, b)));
  }
  file.write(fmt::format("{},{},backs,sum{},reciprocity_m2\n", header, csvField(factors.sky_name),
                         has_error ? ",error" : ""));
  forDenseRows(
      factors, "writing the table", progress, [&](std::size_t a, const std::vector<double>& row) {
        fmt::memory_buffer line;
        const auto out = std::back_inserter(line);
        fmt::format_to(out, "{},{}", csvField(labelOf(factors, a)),
                       areaFigure(factors.matrix->area()[a]));
        for (const double value : row) fmt::format_to(out, ",{}", value);
        const double sum =
            std::accumulate(row.begin(), row.end(), 0.0) + factors.sky[a] + factors.backs[a];
        fmt::format_to(out, ",{},{},{}", factors.sky[a], factors.backs[a], sum);
        if (has_error) fmt::format_to(out, ",{}", factors.error[a]);
        fmt::format_to(out, ",{}\n", largestResidual(factors, a));
        file.write(line.data(), line.size());
      });
}

void writeLongCsv(CheckedFile& file, const NamedFactors& factors, Progress& progress) {
  const bool has_error = !factors.error.empty();
  file.write(
      fmt::format("from,to,area_m2,form_factor{},reciprocity_m2\n", has_error ? ",error" : ""));
  forDenseRows(
      factors, "writing the table", progress, [&](std::size_t a, const std::vector<double>& row) {
        fmt::memory_buffer lines;
        const auto out = std::back_inserter(lines);
        const std::string from = csvField(labelOf(factors, a));
        const double area = areaFigure(factors.matrix->area()[a]);
        for (std::size_t b = 0; b < row.size(); ++b) {
          if (factors.numbered && row[b] == 0) continue;
          fmt::format_to(out, "{},{},{},{}", from, csvField(labelOf(factors, b)), area, row[b]);
          if (has_error) fmt::format_to(out, ",{}", factors.entryError(a, b));
          fmt::format_to(out, ",{}\n", factors.reciprocityResidual(a, b));
        }
        // Sky and backs exchange nothing: they have no residual and no error figure.
        const char* rest = has_error ? ",," : ",";
        fmt::format_to(out, "{0},{1},{2},{3}{5}\n{0},backs,{2},{4}{5}\n", from,
                       csvField(factors.sky_name), area, factors.sky[a], factors.backs[a], rest);
        file.write(lines.data(), lines.size());
      });
}

}  // namespace

void writeFactorsCsv(const std::string& path, const NamedFactors& factors, TableLayout layout,
                     Progress& progress) {
  checkTableRows(path, factors, layout);
  CheckedFile file(path);
  if (layout == TableLayout::wide) {
    writeWideCsv(file, factors, progress);
  } else {
    writeLongCsv(file, factors, progress);
  }
  file.commit();
}

}  // namespace radiosity
