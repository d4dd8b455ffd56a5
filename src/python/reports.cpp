#include "reports.h"

#include <pybind11/stl.h>

#include "keywords.h"
#include "radiosity/names.h"

namespace py = pybind11;

namespace radiosity::python {
namespace {

/// The fields of one record, by name.
template <class Record>
class Fields {
 public:
  explicit Fields(const Record& record) : record_(record) {}
  template <class Value>
  Fields& operator()(const char* name, Value Record::*field) {
    dict_[name] = record_.*field;
    return *this;
  }
  py::dict dict() const { return dict_; }

 private:
  const Record& record_;
  py::dict dict_;
};

py::dict dictOf(const SurfaceAreas& areas) {
  return Fields(areas)("name", &SurfaceAreas::name)("given", &SurfaceAreas::given)(
             "kept", &SurfaceAreas::kept)("buried", &SurfaceAreas::buried)(
             "overlapped", &SurfaceAreas::overlapped)("degenerate", &SurfaceAreas::degenerate)
      .dict();
}

py::dict dictOf(const ClosureReport& report) {
  using R = ClosureReport;
  return Fields(report)("largest_residual_before", &R::largest_residual_before)(
             "rms_residual_before", &R::rms_residual_before)(
             "largest_residual", &R::largest_residual)("largest_move", &R::largest_move)(
             "relative_move", &R::relative_move)("iterations", &R::iterations)(
             "reached", &R::reached)("adjustable", &R::adjustable)("emptied", &R::emptied)(
             "fixed_rows", &R::fixed_rows)
      .dict();
}

py::dict dictOf(const ExactReport& report) {
  using R = ExactReport;
  return Fields(report)("elements", &R::elements)("black_elements", &R::black_elements)(
             "facets", &R::facets)("occluders", &R::occluders)("solids", &R::solids)(
             "skipped_hull", &R::skipped_hull)("no_exchange", &R::no_exchange)(
             "unoccluded", &R::unoccluded)("hidden", &R::hidden)("occluded", &R::occluded)(
             "points", &R::points)("subdivided", &R::subdivided)(
             "evaluated_again", &R::evaluated_again)("rechecked", &R::rechecked)("recheck_ratio",
                                                                                 &R::recheck_ratio)
      .dict();
}

py::dict dictOf(const RayReport& report) {
  using R = RayReport;
  return Fields(report)("triangles", &R::triangles)("rays", &R::rays)("leaked", &R::leaked)(
             "rounds", &R::rounds)("short_rows", &R::short_rows)(
             "loosened_tolerance", &R::loosened_tolerance)("largest_row_figure",
                                                           &R::largest_row_figure)
      .dict();
}

py::dict dictOf(const EnergyAccount& account) {
  using E = EnergyAccount;
  return Fields(account)("emitted", &E::emitted)("from_sky", &E::from_sky)(
             "absorbed", &E::absorbed)("to_sky", &E::to_sky)("on_backs", &E::on_backs)(
             "imbalance", &E::imbalance)
      .dict();
}

py::dict dictOf(const GatherPass& pass) {
  using P = GatherPass;
  py::dict dict = Fields(pass)("seconds", &P::seconds)("change", &P::change)("bound", &P::bound)(
                      "in_flight", &P::in_flight)
                      .dict();
  dict["energy"] = dictOf(pass.energy);
  return dict;
}

}  // namespace

py::list listOf(const std::vector<Note>& notes) {
  py::list list;
  for (const Note& note : notes) {
    py::dict entry;
    entry["severity"] = nameOf(kSeverityNames, note.severity);
    entry["text"] = printable(withKeywords(note.text));
    list.append(entry);
  }
  return list;
}

py::dict dictOf(const MeshReport& report) {
  using R = MeshReport;
  py::dict dict =
      Fields(report)("welded_vertices", &R::welded_vertices)(
          "degenerate_faces", &R::degenerate_faces)("duplicate_faces", &R::duplicate_faces)(
          "nonplanar_faces", &R::nonplanar_faces)("largest_deviation", &R::largest_deviation)(
          "cuts", &R::cuts)("split_edges", &R::split_edges)("hidden_sides", &R::hidden_sides)(
          "nonmanifold_edges", &R::nonmanifold_edges)("polygons", &R::polygons)(
          "triangles", &R::triangles)("quads", &R::quads)("t_junctions", &R::t_junctions)(
          "crossings", &R::crossings)("smallest_angle", &R::smallest_angle)(
          "longest_edge", &R::longest_edge)("clusters", &R::clusters)
          .dict();
  py::list surfaces;
  for (const SurfaceAreas& areas : report.surfaces) surfaces.append(dictOf(areas));
  dict["surfaces"] = surfaces;
  dict["notes"] = listOf(report.notes);
  return dict;
}

py::dict dictOf(const FormFactorReport& report) {
  using R = FormFactorReport;
  py::dict dict =
      Fields(report)("method_reason", &R::method_reason)("hemicubes", &R::hemicubes)(
          "empty_rows", &R::empty_rows)("polygons", &R::polygons)("near_pairs", &R::near_pairs)(
          "exact_rows", &R::exact_rows)("simd_target", &R::simd_target)("seconds", &R::seconds)(
          "seconds_plan", &R::seconds_plan)("estimated_seconds", &R::estimated_seconds)(
          "matrix_bytes", &R::matrix_bytes)("estimated_bytes", &R::estimated_bytes)(
          "reciprocity_residual", &R::reciprocity_residual)(
          "largest_row_error", &R::largest_row_error)("error_figure", &R::error_figure)(
          "closed", &R::closed)("symmetrized", &R::symmetrized)("closure_enforced",
                                                                &R::closure_enforced)
          .dict();
  dict["closure"] = dictOf(report.closure);
  dict["exact"] = dictOf(report.exact);
  dict["rays"] = dictOf(report.rays);
  dict["notes"] = listOf(report.notes);
  return dict;
}

py::dict dictOf(const SolveSummary& summary) {
  using S = SolveSummary;
  py::dict dict = Fields(summary)("iterations", &S::iterations)("rows", &S::rows)(
                      "residual", &S::residual)("error_bound", &S::error_bound)(
                      "seconds", &S::seconds)("residual_history", &S::residual_history)
                      .dict();
  dict["message"] = printable(withKeywords(summary.message));
  dict["status"] = nameOf(kSolveStatusNames, summary.status);
  dict["solver"] = nameOf(kSolverNames, summary.solver);
  dict["usable"] = summary.usable();
  dict["energy"] = dictOf(summary.energy);
  return dict;
}

py::dict dictOf(const GatherSummary& summary) {
  using S = GatherSummary;
  py::dict dict = Fields(summary)("hemicubes", &S::hemicubes)("pixels", &S::pixels)(
                      "closed", &S::closed)("bytes", &S::bytes)("seconds", &S::seconds)
                      .dict();
  dict["message"] = printable(withKeywords(summary.message));
  dict["status"] = nameOf(kGatherStatusNames, summary.status);
  dict["usable"] = summary.usable();
  dict["notes"] = listOf(summary.notes);
  py::list passes;
  for (const GatherPass& pass : summary.passes) passes.append(dictOf(pass));
  dict["passes"] = passes;
  return dict;
}

py::dict dictOf(const HeatSummary& summary) {
  using S = HeatSummary;
  using B = HeatBalance;
  py::dict dict = Fields(summary)("iterations", &S::iterations)("linear_steps", &S::linear_steps)(
                      "residual", &S::residual)("balance_residual", &S::balance_residual)(
                      "undetermined", &S::undetermined)("seconds", &S::seconds)
                      .dict();
  dict["message"] = printable(withKeywords(summary.message));
  dict["status"] = nameOf(kHeatStatusNames, summary.status);
  dict["usable"] = summary.usable();
  dict["balance"] = Fields(summary.balance)("radiated", &B::radiated)("to_sky", &B::to_sky)(
                        "on_backs", &B::on_backs)("imbalance", &B::imbalance)(
                        "convected", &B::convected)("throughput", &B::throughput)
                        .dict();
  return dict;
}

py::dict dictOf(const SurfaceHeat& surface) {
  using S = SurfaceHeat;
  return Fields(surface)("name", &S::name)("area", &S::area)("temperature", &S::temperature)(
             "lowest", &S::lowest)("highest", &S::highest)("radiosity", &S::radiosity)(
             "irradiance", &S::irradiance)("net_flux", &S::net_flux)("radiated", &S::radiated)(
             "convected", &S::convected)("irradiance_error", &S::irradiance_error)
      .dict();
}

}  // namespace radiosity::python
