// The names in a results file, one by one: the layout is this list, and that of each report
// (report_line.h). Lengths are N (patches), units are the attribute `unit` of a dataset; sums and
// reports are attributes of their group.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/printable.h"
#include "radiosity/results.h"
#include "results/archive.h"
#include "scene/lights/light_text.h"

namespace radiosity {

using h5::Described;

template <class Archive>
void describeNotes(Archive& a, Described<Archive, std::vector<Note>>& notes) {
  a.table("notes", notes, [](auto& column) {
    column.choice("severity", &Note::severity, kSeverityNames);
    column("text", &Note::text);
  });
}

/// Gives the figures of a report to an archive.
template <class Archive>
class ReportFields {
 public:
  explicit ReportFields(Archive& archive) : archive_(archive) {}

  void operator()(const ReportLine& line, auto& value) {
    if constexpr (requires { archive_(line.name, value, line.unit); }) {
      archive_(line.name, value, line.unit);
      return;
    }
    if constexpr (Archive::kReading) {
      if (!archive_.hasAttribute(line.name)) return;  // a figure that is newer than the file
    }
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      archive_.choice(line.name, value, tableOf(value));
    } else {
      archive_(line.name, value);
    }
  }
  void part(const char* name, auto& report) {
    archive_.laterGroup(name, [&](auto& inner) { describe(inner, report); });
  }
  void table(const char* name, auto& records, const auto& columns) {
    archive_.table(name, records, columns);
  }
  void notes(auto& notes) { describeNotes(archive_, notes); }

 private:
  Archive& archive_;
};

template <class Archive, class Report>
  requires requires(ReportFields<Archive> fields, Report& report) {
    Report::describe(fields, report);
  }
void describe(Archive& a, Report& report) {
  ReportFields<Archive> fields(a);
  Report::describe(fields, report);
}

template <class Archive>
void describeLights(Archive& a, Described<Archive, std::vector<Light>>& lights, std::size_t bands) {
  std::vector<double> sky = skyRadiance(lights);
  std::vector<std::string> others = otherLights(lights);
  std::vector<std::string> photometric;
  for (const Light& light : lights) {
    if (light.photometric) photometric.push_back(light.name);
  }
  a.numbers("sky", sky, bands);
  a.later("lights", others);
  a.later("photometric_lights", photometric);
  if constexpr (Archive::kReading) {
    try {
      lights = lightsOf(sky, others, int(bands));
      for (Light& light : lights) {
        if (!light.isUniform()) light.validate();
        light.photometric = std::erase(photometric, light.name) > 0;
      }
    } catch (const InputError& error) {
      a.fail("lights", error.what());
    }
    if (!photometric.empty()) {
      a.fail("photometric_lights",
             "names '" + printable(photometric.front()) + "', which is no light");
    }
  }
}

template <class Archive>
void describe(Archive& a, Described<Archive, Scene>& s) {
  a("file", s.file);
  a("unit", s.unit);
  a.laterChoice("up", s.up, kUpNames);
  describeLights(a, s.lights, 3);
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
}

template <class Archive>
void describe(Archive& a, Described<Archive, MeshResult>& m) {
  describe(a, m.mesh);
  a.group("report", [&](auto& report) { describe(report, m.report); });
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
  a.group("report", [&](auto& report) {
    describe(report, f.report);
    describe(report, f.report.hemicube);
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
  describeLights(a, m.lights, bands);
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
  a.group("summary", [&](auto& summary) {
    describe(summary, h.summary);
    summary.group("balance_W", [&](auto& balance) { describe(balance, h.summary.balance); });
  });
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

/// References to the figures of passes, in turn: a number, one that may be missing, or one a band.
class PassFields {
 public:
  struct Field {
    const char* name;
    const char* unit;
    double* number = nullptr;
    std::optional<double>* gap = nullptr;
    std::vector<double>* bands = nullptr;
  };
  static std::vector<Field> of(GatherPass& pass) {
    PassFields list;
    GatherPass::describe(list, pass);
    return list.fields_;
  }
  void operator()(const ReportLine& line, double& value) {
    fields_.push_back({.name = line.name, .unit = line.unit, .number = &value});
  }
  void operator()(const ReportLine& line, std::optional<double>& value) {
    fields_.push_back({.name = line.name, .unit = line.unit, .gap = &value});
  }
  void operator()(const ReportLine& line, std::vector<double>& values) {
    fields_.push_back({.name = line.name, .unit = line.unit, .bands = &values});
  }
  void part(const char* /*name*/, auto& report) { report.describe(*this, report); }

 private:
  std::vector<Field> fields_;
};

inline void append(const PassFields::Field& field, std::vector<double>& column) {
  if (field.number != nullptr) column.push_back(*field.number);
  if (field.gap != nullptr) {
    column.push_back(field.gap->value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  if (field.bands != nullptr) {
    column.insert(column.end(), field.bands->begin(), field.bands->end());
  }
}

inline void set(const PassFields::Field& field, std::span<const double> numbers) {
  if (field.number != nullptr) *field.number = numbers[0];
  if (field.gap != nullptr && !std::isnan(numbers[0])) *field.gap = numbers[0];
  if (field.bands != nullptr) field.bands->assign(numbers.begin(), numbers.end());
}

/// Passes as a table: a row each, a column a field.
template <class Archive>
void describePasses(Archive& a, Described<Archive, std::vector<GatherPass>>& passes,
                    std::size_t bands) {
  std::vector<GatherPass> rows = passes;
  GatherPass none;
  const std::vector<PassFields::Field> fields = PassFields::of(none);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto& [name, unit, number, gap, of_bands] = fields[f];
    const std::size_t width = of_bands != nullptr ? bands : 1;
    std::vector<double> column;
    for (GatherPass& row : rows) append(PassFields::of(row)[f], column);
    if (number != nullptr) a(name, column, unit);
    if (gap != nullptr) a.gaps(name, column, unit);
    if (of_bands != nullptr) a.rows(name, column, width, unit);
    if constexpr (Archive::kReading) {
      if (f == 0) rows.resize(column.size());
      if (column.size() != width * rows.size()) a.fail(name, "is not as long as its table");
      for (std::size_t k = 0; k < rows.size(); ++k) {
        set(PassFields::of(rows[k])[f], std::span(column).subspan(k * width, width));
      }
    }
  }
  if constexpr (Archive::kReading) passes = std::move(rows);
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
  a.group("summary", [&](auto& summary) {
    describe(summary, g.summary);
    summary.group("passes", [&](auto& list) { describePasses(list, g.summary.passes, bands); });
  });
}

}  // namespace radiosity
