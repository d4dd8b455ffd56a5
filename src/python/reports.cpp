#include "reports.h"

#include <pybind11/stl.h>

#include "radiosity/names.h"

namespace py = pybind11;

namespace radiosity::python {
namespace {

py::dict fieldsOf(const auto& report);

/// The figures of a report, by name.
class Fields {
 public:
  py::dict dict;

  void operator()(const ReportLine& line, const auto& value) {
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      dict[line.name] = nameOf(tableOf(value), value);
    } else {
      dict[line.name] = value;
    }
  }
  void part(const char* name, const auto& report) { dict[name] = fieldsOf(report); }
  template <class Record>
  void table(const char* name, const std::vector<Record>& records, const auto& columns) {
    py::list rows;
    for (const Record& record : records) {
      py::dict row;
      const auto put = [&](const char* column, auto field, const char* /*unit*/ = "") {
        row[column] = record.*field;
      };
      columns(put);
      rows.append(row);
    }
    dict[name] = rows;
  }
  void notes(const std::vector<Note>& notes) { dict["notes"] = listOf(notes); }
};

py::dict fieldsOf(const auto& report) {
  Fields fields;
  report.describe(fields, report);
  return fields.dict;
}

py::dict summaryOf(const auto& summary) {
  py::dict dict = fieldsOf(summary);
  dict["message"] = printable(summary.message);
  dict["usable"] = summary.usable();
  return dict;
}

}  // namespace

py::list listOf(const std::vector<Note>& notes) {
  py::list list;
  for (const Note& note : notes) {
    py::dict entry;
    entry["severity"] = nameOf(kSeverityNames, note.severity);
    entry["text"] = printable(note.text);
    list.append(entry);
  }
  return list;
}

py::dict dictOf(const MeshReport& report) { return fieldsOf(report); }

py::dict dictOf(const FormFactorReport& report) {
  Fields fields;
  FormFactorReport::describe(fields, report);
  HemicubeReport::describe(fields, report.hemicube);
  return fields.dict;
}

py::dict dictOf(const SolveSummary& summary) { return summaryOf(summary); }

py::dict dictOf(const GatherSummary& summary) {
  py::dict dict = summaryOf(summary);
  py::list passes;
  for (const GatherPass& pass : summary.passes) passes.append(fieldsOf(pass));
  dict["passes"] = passes;
  return dict;
}

py::dict dictOf(const HeatSummary& summary) {
  py::dict dict = summaryOf(summary);
  dict["balance"] = fieldsOf(summary.balance);
  return dict;
}

py::dict dictOf(const SurfaceHeat& surface) { return fieldsOf(surface); }

}  // namespace radiosity::python
