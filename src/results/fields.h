// The names in a results file, one by one: the layout is this list. Lengths are N (patches),
// units are the attribute `unit` of a dataset; sums and reports are attributes of their group.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/results.h"
#include "results/archive.h"

namespace radiosity {

using h5::Described;

template <class Archive>
void describeNotes(Archive& a, Described<Archive, std::vector<Note>>& notes) {
  a.table("notes", notes, [](auto& column) {
    column.choice("severity", &Note::severity, kSeverityNames);
    column("text", &Note::text);
  });
}

template <class Archive>
void describe(Archive& a, Described<Archive, Scene>& s) {
  a("file", s.file);
  a("unit", s.unit);
  a.laterChoice("up", s.up, kUpNames);
  a("sky", s.sky);
  a("vertices", s.vertices, "m");
  a("face_offset", s.face_offset);
  a("corners", s.corners);
  a("texcoords", s.texcoords);
  a.laterRows("colours", s.colours);
  a("face_surface", s.face_surface);
  a("face_element", s.face_element);
  a.table("surfaces", s.surfaces, [](auto& column) {
    column("name", &Surface::name);
    column("object", &Surface::object);
    column("material", &Surface::material);
  });
  a.table("materials", s.materials, [](auto& column) {
    column("name", &Material::name);
    column("reflectance", &Material::reflectance);
    column("emission", &Material::emission, "W/m^2");
    column("two_sided", &Material::two_sided);
    column("texture", &Material::texture);
    column("emission_texture", &Material::emission_texture);
  });
  a.table("cameras", s.cameras, [](auto& column) {
    column("name", &Camera::name);
    column("eye", &Camera::eye, "m");
    column("target", &Camera::target, "m");
    column("up", &Camera::up);
    column("vertical_fov", &Camera::vertical_fov, "rad");
    column("aspect", &Camera::aspect);
  });
  a.table("textures", s.textures, [](auto& column) {
    column("name", &Texture::name);
    column("width", &Texture::width);
    column("height", &Texture::height);
    column("repeat", &Texture::repeat);
  });
  a.group("texels", [&](auto& texels) {
    for (std::size_t k = 0; k < s.textures.size(); ++k) {
      texels.rows(std::to_string(k).c_str(), s.textures[k].texels, 3);
    }
  });
  describeNotes(a, s.notes);
}

template <class Archive>
void describe(Archive& a, Described<Archive, PlanarPolygons>& p) {
  a("loop_offset", p.loop_offset);
  a("corner_offset", p.corner_offset);
  a("corners", p.corners);
  a("normal", p.normal);
  a("origin", p.origin, "m");
  a("surface", p.surface);
  a("index_in_surface", p.index_in_surface);
  a("back_is_patch", p.back_is_patch);
}

template <class Archive>
void describe(Archive& a, Described<Archive, PatchMesh>& m) {
  a("vertices", m.vertices, "m");
  a("corner_offset", m.corner_offset);
  a("corners", m.corners);
  a("piece_offset", m.piece_offset);
  a("pieces", m.pieces);
  a("centroid", m.centroid, "m");
  a("normal", m.normal);
  a("area", m.area, "m^2");
  a("polygon", m.polygon);
  a("surface", m.surface);
  a("index_in_surface", m.index_in_surface);
  a("source_face", m.source_face);
  a("side", m.side);
  a("twin", m.twin);
  a("surface_names", m.surface_names);
  a("coincidence", m.coincidence);
  a.group("polygons", [&](auto& polygons) { describe(polygons, m.polygons); });
  if (a.present("clusters", m.clusters)) {
    a.group("clusters", [&](auto& clusters) { clusters("of_patch", m.clusters->of_patch); });
  }
}

template <class Archive>
void describe(Archive& a, Described<Archive, MeshReport>& r) {
  a("welded_vertices", r.welded_vertices);
  a("degenerate_faces", r.degenerate_faces);
  a("duplicate_faces", r.duplicate_faces);
  a("nonplanar_faces", r.nonplanar_faces);
  a("largest_deviation", r.largest_deviation);
  a("cuts", r.cuts);
  a("split_edges", r.split_edges);
  a("hidden_sides", r.hidden_sides);
  a("nonmanifold_edges", r.nonmanifold_edges);
  a("polygons", r.polygons);
  a("triangles", r.triangles);
  a("quads", r.quads);
  a("t_junctions", r.t_junctions);
  a("crossings", r.crossings);
  a("smallest_angle", r.smallest_angle);
  a("smallest_angle_surface", r.smallest_angle_surface);
  a("longest_edge", r.longest_edge);
  a("clusters", r.clusters);
  a("widest_cone", r.widest_cone);
  a.table("surfaces", r.surfaces, [](auto& column) {
    column("name", &SurfaceAreas::name);
    column("given", &SurfaceAreas::given, "m^2");
    column("kept", &SurfaceAreas::kept, "m^2");
    column("buried", &SurfaceAreas::buried, "m^2");
    column("overlapped", &SurfaceAreas::overlapped, "m^2");
    column("degenerate", &SurfaceAreas::degenerate, "m^2");
  });
  describeNotes(a, r.notes);
}

template <class Archive>
void describe(Archive& a, Described<Archive, MeshResult>& m) {
  describe(a, m.mesh);
  a.group("report", [&](auto& report) { describe(report, m.report); });
}

template <class Archive>
void describe(Archive& a, Described<Archive, ClosureReport>& r) {
  a("largest_residual_before", r.largest_residual_before);
  a("rms_residual_before", r.rms_residual_before);
  a("largest_residual", r.largest_residual);
  a("largest_move", r.largest_move);
  a("relative_move", r.relative_move);
  a("iterations", r.iterations);
  a("reached", r.reached);
  a("adjustable", r.adjustable);
  a("emptied", r.emptied);
  a("fixed_rows", r.fixed_rows);
}

template <class Archive>
void describe(Archive& a, Described<Archive, ExactReport>& r) {
  a("elements", r.elements);
  a("black_elements", r.black_elements);
  a("facets", r.facets);
  a("occluders", r.occluders);
  a("solids", r.solids);
  a("skipped_hull", r.skipped_hull);
  a("no_exchange", r.no_exchange);
  a("unoccluded", r.unoccluded);
  a("hidden", r.hidden);
  a("occluded", r.occluded);
  a("facet_pairs", r.facet_pairs);
  a("facet_pairs_no_exchange", r.facet_pairs_no_exchange);
  a("facet_pairs_unoccluded", r.facet_pairs_unoccluded);
  a("shaft_tests", r.shaft_tests);
  a("contour", r.contour);
  a("lambert", r.lambert);
  a("product", r.product);
  a("clipped", r.clipped);
  a("points", r.points);
  a("subdivided", r.subdivided);
  a("evaluated_again", r.evaluated_again);
  a("rechecked", r.rechecked);
  a("recheck_ratio", r.recheck_ratio);
  a("seconds_prepare", r.seconds_prepare);
  a("seconds_visibility", r.seconds_visibility);
  a("seconds_unoccluded", r.seconds_unoccluded);
  a("seconds_occluded", r.seconds_occluded);
  a("seconds_assembly", r.seconds_assembly);
  a("seconds_finish", r.seconds_finish);
}

template <class Archive>
void describe(Archive& a, Described<Archive, RayReport>& r) {
  a("triangles", r.triangles);
  a("rays", r.rays);
  a("leaked", r.leaked);
  a("rounds", r.rounds);
  a("short_rows", r.short_rows);
  a("loosened_tolerance", r.loosened_tolerance);
  a("largest_row_figure", r.largest_row_figure);
  a("seconds_prepare", r.seconds_prepare);
  a("seconds_cast", r.seconds_cast);
  a("seconds_merge", r.seconds_merge);
  a("seconds_close", r.seconds_close);
}

template <class Archive>
void describe(Archive& a, Described<Archive, FormFactorReport>& r) {
  a("method_reason", r.method_reason);
  a("hemicubes", r.hemicubes);
  a("empty_rows", r.empty_rows);
  a("polygons", r.polygons);
  a("rasterised_polygons", r.rasterised_polygons);
  a("skipped_own_plane", r.skipped_own_plane);
  a("skipped_horizon", r.skipped_horizon);
  a("skipped_facing_away", r.skipped_facing_away);
  a("skipped_face", r.skipped_face);
  a("skipped_hidden", r.skipped_hidden);
  a("pixels", r.pixels);
  a("near_pairs", r.near_pairs);
  a("capped", r.capped);
  a("exact_rows", r.exact_rows);
  a("simd_target", r.simd_target);
  a("seconds", r.seconds);
  a("matrix_bytes", r.matrix_bytes);
  a("estimated_bytes", r.estimated_bytes);
  a("seconds_plan", r.seconds_plan);
  a("estimated_seconds", r.estimated_seconds);
  a("reciprocity_residual", r.reciprocity_residual);
  a("largest_row_error", r.largest_row_error);
  a("error_figure", r.error_figure);
  a("closed", r.closed);
  a("symmetrized", r.symmetrized);
  a.group("closure", [&](auto& closure) { describe(closure, r.closure); });
  a("closure_enforced", r.closure_enforced);
  a.group("exact", [&](auto& exact) { describe(exact, r.exact); });
  a.group("rays", [&](auto& rays) { describe(rays, r.rays); });
  describeNotes(a, r.notes);
}

/// The accounts; the matrix itself is streamed (matrix_blocks.h).
template <class Archive>
void describe(Archive& a, Described<Archive, FormFactors>& f) {
  a.choice("method", f.method, kFactorsFromNames);
  a("fronts", f.fronts);
  a("backs", f.backs);
  a("sky", f.sky);
  a("backs_by_surface", f.backs_by_surface);
  a("error", f.error);
  a.group("report", [&](auto& report) { describe(report, f.report); });
}

template <class Archive>
void describe(Archive& a, Described<Archive, SolveSummary>& s) {
  a.choice("status", s.status, kSolveStatusNames);
  a.laterChoice("solver", s.solver, kSolverNames);
  a("iterations", s.iterations);
  a("rows", s.rows);
  a.group("skipped", [&](auto& skipped) {
    skipped("black_patches", s.skipped.black_patches);
    skipped("dark_bands", s.skipped.dark_bands);
    skipped("equal_bands", s.skipped.equal_bands);
  });
  a("residual", s.residual);
  a("error_bound", s.error_bound);
  a("seconds", s.seconds);
  a("message", s.message);
  a("residual_history", s.residual_history);
  a.group("energy", [&](auto& energy) {
    energy("emitted", s.energy.emitted, "W");
    energy("from_sky", s.energy.from_sky, "W");
    energy("absorbed", s.energy.absorbed, "W");
    energy("to_sky", s.energy.to_sky, "W");
    energy("on_backs", s.energy.on_backs, "W");
    energy("imbalance", s.energy.imbalance, "W");
  });
}

template <class Archive>
void describe(Archive& a, Described<Archive, Solution>& s) {
  a("bands", s.bands);
  a.rows("radiosity", s.radiosity, std::size_t(s.bands), "W/m^2");
  a.rows("irradiance", s.irradiance, std::size_t(s.bands), "W/m^2");
  a.group("summary", [&](auto& summary) { describe(summary, s.summary); });
}

template <class Archive>
void describe(Archive& a, Described<Archive, ElementField>& f, std::size_t bands) {
  a.table("elements", f.elements, [](auto& column) {
    column("first_child", &Element::first_child);
    column("first_point", &Element::first_point);
    column("corners", &Element::corners);
    column("tested", &Element::tested);
  });
  a("points", f.points);
  a("vertices", f.vertices);
  a.rows("values", f.values, bands, "W/m^2");
}

template <class Archive>
void describe(Archive& a, Described<Archive, ElementReport>& r) {
  a.choice("direct", r.direct, kDirectLightNames);
  a("roots", r.roots);
  a("as_solved", r.as_solved);
  a("emitters", r.emitters);
  a("direct_vertices", r.direct_vertices);
  a("direct_by_rays", r.direct_by_rays);
  a("indirect_vertices", r.indirect_vertices);
  a("uniform_vertices", r.uniform_vertices);
  a("unrefined", r.unrefined);
  a("rays", r.rays);
  a("rays_a_vertex", r.rays_a_vertex);
  a("edge", r.edge);
  a("interpolation_error", r.interpolation_error);
  a("ray_error", r.ray_error);
  a("seconds_direct", r.seconds_direct);
  a("seconds_indirect", r.seconds_indirect);
}

template <class Archive>
void describe(Archive& a, Described<Archive, Elements>& e) {
  a("bands", e.bands);
  const auto bands = std::size_t(std::max(e.bands, 1));  // results_check.cpp refuses others
  a.group("roots", [&](auto& roots) {
    roots("patch", e.roots.patch);
    roots("corner", e.roots.corner);
    roots("of_patch", e.roots.of_patch);
  });
  a.group("direct", [&](auto& field) { describe(field, e.direct, bands); });
  a.group("indirect", [&](auto& field) { describe(field, e.indirect, bands); });
  a.group("report", [&](auto& report) { describe(report, e.report); });
}

template <class Archive>
void describe(Archive& a, Described<Archive, PatchMaterials>& m) {
  if constexpr (Archive::kReading) m.bands = a.columns("reflectance");
  const auto bands = std::size_t(m.bands);
  a.rows("reflectance", m.reflectance, bands);
  a.rows("emission", m.emission, bands, "W/m^2");
  a.numbers("sky", m.sky, bands);
}

template <class Archive>
void describe(Archive& a, Described<Archive, HeatSummary>& s) {
  a.choice("status", s.status, kHeatStatusNames);
  a("iterations", s.iterations);
  a("linear_steps", s.linear_steps);
  a("residual", s.residual);
  a("balance_residual", s.balance_residual);
  a("undetermined", s.undetermined);
  a("seconds", s.seconds);
  a("message", s.message);
  a.group("balance_W", [&](auto& balance) {
    balance("radiated", s.balance.radiated);
    balance("to_sky", s.balance.to_sky);
    balance("on_backs", s.balance.on_backs);
    balance("imbalance", s.balance.imbalance);
    balance("convected", s.balance.convected);
    balance("throughput", s.balance.throughput);
  });
}

template <class Archive>
void describe(Archive& a, Described<Archive, HeatSolution>& h) {
  a("bands", h.bands);
  const auto bands = std::size_t(std::max(h.bands, 1));  // results_check.cpp refuses others
  a.rows("radiosity", h.radiosity, bands, "W/m^2");
  a.rows("irradiance", h.irradiance, bands, "W/m^2");
  a("net_flux", h.net_flux, "W/m^2");
  a("convection", h.convection, "W/m^2");
  a.gaps("temperature", h.temperature, "K");
  a.group("summary", [&](auto& summary) { describe(summary, h.summary); });
  a.laterText("condition_table", h.conditions.table);
  a.later("condition_settings", h.conditions.settings);
  a.later("condition_groups", h.conditions.groups);
}

/// Bands of the materials and of the light are those of all sources.
template <class Archive>
void describe(Archive& a, Described<Archive, LightBasis>& l) {
  a("names", l.names);
  a("bands", l.bands);
  describe(a, l.materials);
  if constexpr (Archive::kReading) l.solution.bands = l.materials.bands;
  const auto columns = std::size_t(std::max(l.solution.bands, 1));  // see results_check.cpp
  a.rows("radiosity", l.solution.radiosity, columns, "W/m^2");
  a.rows("irradiance", l.solution.irradiance, columns, "W/m^2");
  a.group("summary", [&](auto& summary) { describe(summary, l.solution.summary); });
}

/// Passes in the file's layout: one row each.
struct PassColumns {
  std::size_t bands;
  std::vector<double> seconds, change, bound;  // P
  // P x bands
  std::vector<double> emitted, from_sky, absorbed, to_sky, on_backs, imbalance, in_flight;

  explicit PassColumns(std::size_t band_count) : bands(band_count) {}
  PassColumns(const std::vector<GatherPass>& passes, std::size_t band_count) : bands(band_count) {
    const auto append = [](std::vector<double>& to, const std::vector<double>& row) {
      to.insert(to.end(), row.begin(), row.end());
    };
    for (const GatherPass& pass : passes) {
      seconds.push_back(pass.seconds);
      change.push_back(pass.change);
      bound.push_back(pass.bound.value_or(std::numeric_limits<double>::quiet_NaN()));
      append(emitted, pass.energy.emitted);
      append(from_sky, pass.energy.from_sky);
      append(absorbed, pass.energy.absorbed);
      append(to_sky, pass.energy.to_sky);
      append(on_backs, pass.energy.on_backs);
      append(imbalance, pass.energy.imbalance);
      append(in_flight, pass.in_flight);
    }
  }
  /// The first column that is not as long as `seconds`; null: all are.
  const char* unequal() const {
    if (change.size() != seconds.size()) return "change";
    if (bound.size() != seconds.size()) return "bound";
    const std::pair<const char*, const std::vector<double>*> columns[] = {
        {"emitted", &emitted},    {"from_sky", &from_sky}, {"absorbed", &absorbed},
        {"to_sky", &to_sky},      {"on_backs", &on_backs}, {"imbalance", &imbalance},
        {"in_flight", &in_flight}};
    for (const auto& [name, column] : columns) {
      if (column->size() != bands * seconds.size()) return name;
    }
    return nullptr;
  }
  std::vector<GatherPass> passes() const {
    const auto bandsOf = [&](const std::vector<double>& from, std::size_t pass) {
      const auto first = from.begin() + std::ptrdiff_t(bands * pass);
      return std::vector<double>(first, first + std::ptrdiff_t(bands));
    };
    std::vector<GatherPass> result(seconds.size());
    for (std::size_t k = 0; k < result.size(); ++k) {
      GatherPass& pass = result[k];
      pass.seconds = seconds[k];
      pass.change = change[k];
      if (!std::isnan(bound[k])) pass.bound = bound[k];
      pass.energy = {bandsOf(emitted, k), bandsOf(from_sky, k), bandsOf(absorbed, k),
                     bandsOf(to_sky, k),  bandsOf(on_backs, k), bandsOf(imbalance, k)};
      pass.in_flight = bandsOf(in_flight, k);
    }
    return result;
  }
};

template <class Archive>
void describe(Archive& a, Described<Archive, PassColumns>& p) {
  a("seconds", p.seconds, "s");
  a("change", p.change);
  a.gaps("bound", p.bound, "W/m^2");
  a.rows("emitted", p.emitted, p.bands, "W");
  a.rows("from_sky", p.from_sky, p.bands, "W");
  a.rows("absorbed", p.absorbed, p.bands, "W");
  a.rows("to_sky", p.to_sky, p.bands, "W");
  a.rows("on_backs", p.on_backs, p.bands, "W");
  a.rows("imbalance", p.imbalance, p.bands, "W");
  a.rows("in_flight", p.in_flight, p.bands, "W");
}

template <class Archive>
void describe(Archive& a, Described<Archive, GatherSummary>& s, std::size_t bands) {
  a.choice("status", s.status, kGatherStatusNames);
  a("hemicubes", s.hemicubes);
  a("pixels", s.pixels);
  a("closed", s.closed);
  a("bytes", s.bytes);
  a("simd_target", s.simd_target);
  a("seconds", s.seconds);
  a("message", s.message);
  describeNotes(a, s.notes);
  a.group("passes", [&](auto& passes) {
    if constexpr (Archive::kReading) {
      PassColumns columns(bands);
      describe(passes, columns);
      if (const char* column = columns.unequal()) {
        passes.fail(column, "is not as long as its table");
      }
      s.passes = columns.passes();
    } else {
      const PassColumns columns(s.passes, bands);
      describe(passes, columns);
    }
  });
}

template <class Archive>
void describe(Archive& a, Described<Archive, Gathered>& g) {
  a.choice("at", g.at, kGatherAtNames);
  a("bands", g.bands);
  const auto bands = std::size_t(std::max(g.bands, 1));  // results_check.cpp refuses others
  a.rows("radiosity", g.radiosity, bands, "W/m^2");
  a.rows("irradiance", g.irradiance, bands, "W/m^2");
  a("backs", g.backs);
  a("sky", g.sky);
  a("backs_by_surface", g.backs_by_surface);
  a("area", g.area, "m^2");
  a("position", g.position, "m");
  a("eye_of_corner", g.eye_of_corner);
  a.group("summary", [&](auto& summary) { describe(summary, g.summary, bands); });
}

}  // namespace radiosity
