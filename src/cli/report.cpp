#include "cli/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/figure_text.h"
#include "cli/words.h"
#include "radiosity/base.h"
#include "radiosity/names.h"

namespace radiosity::cli {

using nlohmann::json;

namespace {

constexpr int kLabelWidth = 32;  // a blank follows, also after longer labels
constexpr int kStageWidth = 15;
constexpr std::size_t kAlike = 3;       // notes of one shape that are printed
constexpr std::size_t kMostNotes = 30;  // of one severity, beyond which they are only counted

// fputs instead of fmt::print, so that a closed pipe does not end the run.
void put(std::FILE* stream, const std::string& text) {
  std::fputs(text.c_str(), stream);
  std::fflush(stream);
}

void printNote(Severity severity, const std::string& text) {
  if (severity == Severity::info) {
    put(stdout, fmt::format("note: {}\n", text));
  } else {
    put(stderr, fmt::format("radiosity: {}: {}\n",
                            severity == Severity::loud ? "WARNING" : "warning", text));
  }
}

/// The text without its names and numbers, which is the same for notes of one kind. What stands in
/// quotes is a name; so is a word with a slash, as most surfaces have, and before a colon all words
/// up to it. A number has a digit.
std::string shapeOf(const std::string& text) {
  std::string shape;
  std::string word;
  char quote = 0;
  const auto endWord = [&] {
    const bool varies = std::ranges::any_of(
        word, [](char c) { return c == '/' || std::isdigit(static_cast<unsigned char>(c)) != 0; });
    if (!varies) shape += word + ' ';
    if (varies && word.ends_with(':')) shape.clear();
    word.clear();
  };
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == ' ') {
      endWord();
    } else {
      word += c;
    }
  }
  endWord();
  return shape;
}

json numberOrText(const std::string& cell) {
  std::string plain;
  std::copy_if(cell.begin(), cell.end(), std::back_inserter(plain),
               [](char c) { return c != ','; });
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc() || end != plain.data() + plain.size()) return cell;
  return value;
}

}  // namespace

Report::Report(bool quiet) : quiet_(quiet), root_(std::make_unique<json>(json::object())) {
  (*root_)["program"] = "radiosity";
  (*root_)["stages"] = json::object();
  (*root_)["notes"] = json::array();
  (*root_)["outputs"] = json::array();
}

Report::~Report() = default;

json& Report::here() { return section_.empty() ? *root_ : (*root_)[section_]; }

void Report::section(const std::string& key, const std::string& title) {
  section_ = key;
  if (!root_->contains(key)) (*root_)[key] = json::object();
  if (!muted()) put(stdout, "\n" + title + "\n");
}

void Report::figure(const std::string& label, const std::string& value) const {
  if (!muted()) put(stdout, fmt::format("  {:<{}} {}\n", label, kLabelWidth, oneLine(value)));
}

void Report::count(const std::string& key, const std::string& label, std::size_t value) {
  here()[key] = value;
  figure(label, countText(value));
}

void Report::largeCount(const std::string& key, const std::string& label, double value) {
  constexpr double kMostCounted = 1e18;
  here()[key] = std::round(value);
  figure(label,
         value < kMostCounted ? countText(std::size_t(std::llround(value))) : numberText(value));
}

void Report::number(const std::string& key, const std::string& label, double value,
                    const std::string& unit) {
  here()[key] = value;
  figure(label, numberText(value) + (unit.empty() ? "" : " " + unit));
}

void Report::bytes(const std::string& key, const std::string& label, std::size_t value) {
  here()[key] = value;
  figure(label, bytesText(value));
}

void Report::seconds(const std::string& key, const std::string& label, double value) {
  here()[key] = value;
  figure(label, durationText(value));
}

void Report::text(const std::string& key, const std::string& label, const std::string& value) {
  here()[key] = value;
  figure(label, value);
}

void Report::yesNo(const std::string& key, const std::string& label, bool value) {
  here()[key] = value;
  figure(label, value ? "yes" : "no");
}

void Report::bands(const std::string& key, const std::string& label, std::span<const double> values,
                   const std::string& unit, int digits) {
  here()[key] = std::vector<double>(values.begin(), values.end());
  std::string text;
  for (const double value : values) {
    text += fmt::format("{:>{}}", numberText(value, digits), digits + 7);
  }
  figure(label, text + "  " + unit);
}

void Report::series(const std::string& key, std::span<const double> values) {
  here()[key] = std::vector<double>(values.begin(), values.end());
}

void Report::table(const std::string& key, const std::vector<Column>& columns,
                   const std::vector<std::vector<std::string>>& rows, std::size_t most) {
  json& list = here()[key] = json::array();
  std::vector<std::size_t> width;
  width.reserve(columns.size());
  for (const Column& column : columns) width.push_back(column.title.size());
  for (const auto& row : rows) {
    json entry;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      entry[columns[c].key] = columns[c].numeric ? numberOrText(row[c]) : json(row[c]);
    }
    list.push_back(std::move(entry));
  }
  if (muted() || rows.empty()) return;
  const std::size_t shown = std::min(most, rows.size());
  for (std::size_t r = 0; r < shown; ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      width[c] = std::max(width[c], oneLine(rows[r][c]).size());
    }
  }
  const auto printRow = [&](auto&& cell) {
    std::string line = " ";
    for (std::size_t c = 0; c < columns.size(); ++c) {
      line += columns[c].numeric ? fmt::format(" {:>{}} ", cell(c), width[c])
                                 : fmt::format(" {:<{}} ", cell(c), width[c]);
    }
    put(stdout, line.substr(0, line.find_last_not_of(' ') + 1) + "\n");
  };
  printRow([&](std::size_t c) { return columns[c].title; });
  for (std::size_t r = 0; r < shown; ++r) {
    printRow([&](std::size_t c) { return oneLine(rows[r][c]); });
  }
  if (rows.size() > shown) {
    put(stdout, fmt::format("  ... and {} more (all are in --report FILE)\n",
                            countText(rows.size() - shown)));
  }
}

void Report::stage(const std::string& key, const std::string& label, const std::string& action,
                   const std::string& detail, double seconds) {
  (*root_)["stages"][key] = {{"action", action}, {"detail", detail}};
  if (seconds >= 0) (*root_)["stages"][key]["seconds"] = seconds;
  line(label, action + (detail.empty() ? "" : (action == "reused" ? " from " : ": ") + detail));
}

void Report::line(const std::string& label, const std::string& text) {
  if (!muted()) put(stdout, fmt::format("{:<{}}{}\n", label, kStageWidth, oneLine(text)));
}

void Report::notes(std::span<const Note> notes) {
  for (const Severity severity : {Severity::loud, Severity::warning, Severity::info}) {
    std::map<std::string, std::vector<std::string>> alike;  // the first few, by shape
    std::map<std::string, std::size_t> count;
    std::vector<std::string> shapes;  // in order of the first note
    for (const Note& note : notes) {
      if (note.severity != severity) continue;
      (*root_)["notes"].push_back(
          {{"severity", nameOf(kSeverityNames, severity)}, {"text", note.text}});
      const std::string text = oneLine(note.text);
      const std::string shape = shapeOf(text);
      if (++count[shape] == 1) shapes.push_back(shape);
      if (alike[shape].size() < kAlike) alike[shape].push_back(text);
    }
    if (quiet_ && severity != Severity::loud) continue;
    std::size_t printed = 0;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (severity != Severity::loud && printed >= kMostNotes) {
        printNote(severity, fmt::format("{} more kinds of notes (all are in --report FILE)",
                                        countText(shapes.size() - k)));
        break;
      }
      const std::string& shape = shapes[k];
      const std::vector<std::string>& lines = alike[shape];
      printed += lines.size();
      for (std::size_t n = 0; n < lines.size(); ++n) {
        const std::size_t left = n + 1 == lines.size() ? count[shape] - lines.size() : 0;
        printNote(
            severity,
            lines[n] + (left == 0 ? "" : fmt::format(" (and {} more like this)", countText(left))));
      }
    }
  }
}

void Report::output(const std::string& path, std::size_t bytes, const std::string& what) {
  const json written = {{"path", path}, {"bytes", bytes}, {"what", what}};
  json& outputs = (*root_)["outputs"];
  const auto before = std::find_if(outputs.begin(), outputs.end(),
                                   [&](const json& output) { return output["path"] == path; });
  if (before != outputs.end()) {
    *before = written;
  } else {
    outputs.push_back(written);
  }
  line("wrote", fmt::format("{}  ({}, {})", path, what, bytesText(bytes)));
}

void Report::fact(const std::string& key, const std::string& value) { (*root_)[key] = value; }

void Report::fact(const std::string& key, const std::vector<std::string>& values) {
  (*root_)[key] = values;
}

void Report::exitCode(int code) { (*root_)["exit_code"] = code; }

void Report::write(const std::string& path) const {
  writeWholeFile(path, root_->dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace radiosity::cli
