// Writes tables as JSON, one row at a time.
#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

std::string dumped(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// "key": [...] with a value for each row.
std::string member(const char* key, std::span<const double> values) {
  return fmt::format("\"{}\": {}", key, dumped(std::vector<double>(values.begin(), values.end())));
}

using ValueOf = std::function<double(std::size_t a, std::size_t b)>;

/// "key": [[...], ...] with a value for each pair.
void writeSquare(CheckedFile& file, const char* key, const NamedFactors& factors,
                 const ValueOf& value) {
  file.write(fmt::format(",\n\"{}\": [", key));
  std::vector<double> row(factors.size());
  for (std::size_t a = 0; a < factors.size(); ++a) {
    for (std::size_t b = 0; b < row.size(); ++b) row[b] = value(a, b);
    file.write((a == 0 ? "\n" : ",\n") + dumped(row));
  }
  file.write("\n]");
}

void writeWideJson(CheckedFile& file, const NamedFactors& factors, Progress& progress) {
  file.write(",\n\"form_factors\": [");
  forDenseRows(factors, "writing the table", progress,
               [&](std::size_t a, const std::vector<double>& row) {
                 file.write((a == 0 ? "\n" : ",\n") + dumped(row));
               });
  file.write("\n],\n" + member("sky", factors.sky) + ",\n" + member("backs", factors.backs));
  if (!factors.error.empty()) {
    writeSquare(file, "entry_error", factors,
                [&](std::size_t a, std::size_t b) { return factors.entryError(a, b); });
  }
  writeSquare(file, "reciprocity_m2", factors,
              [&](std::size_t a, std::size_t b) { return factors.reciprocityResidual(a, b); });
}

void writeLongJson(CheckedFile& file, const NamedFactors& factors, Progress& progress) {
  const auto label = [&](std::size_t a) {
    return factors.numbered ? nlohmann::json(a) : nlohmann::json(factors.names[a]);
  };
  file.write(",\n\"pairs\": [");
  bool first = true;
  const auto write = [&](const nlohmann::ordered_json& pair) {
    file.write(first ? "\n" : ",\n");
    first = false;
    file.write(pair.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  };
  forDenseRows(
      factors, "writing the table", progress, [&](std::size_t a, const std::vector<double>& row) {
        for (std::size_t b = 0; b < row.size(); ++b) {
          if (factors.numbered && row[b] == 0) continue;
          nlohmann::ordered_json pair = {
              {"from", label(a)}, {"to", label(b)}, {"form_factor", row[b]}};
          if (!factors.error.empty()) pair["error"] = factors.entryError(a, b);
          pair["reciprocity_m2"] = factors.reciprocityResidual(a, b);
          write(pair);
        }
        write({{"from", label(a)}, {"to", factors.sky_name}, {"form_factor", factors.sky[a]}});
        write({{"from", label(a)}, {"to", "backs"}, {"form_factor", factors.backs[a]}});
      });
  file.write("\n]");
}

}  // namespace

void writeFactorsJson(const std::string& path, const NamedFactors& factors, TableLayout layout,
                      Progress& progress) {
  checkTableRows(path, factors, layout);
  CheckedFile file(path);
  file.write("{\"names\": " + dumped(factors.names) + ",\n");
  file.write(member("area_m2", factors.matrix->area()));
  file.write(",\n\"sky_name\": " + dumped(factors.sky_name));
  if (!factors.error.empty()) file.write(",\n" + member("error", factors.error));
  if (layout == TableLayout::wide) {
    writeWideJson(file, factors, progress);
  } else {
    writeLongJson(file, factors, progress);
  }
  file.write("\n}\n");
  file.commit();
}

}  // namespace radiosity
