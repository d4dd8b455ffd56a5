// Results with every field filled, each differently, and the comparison of two of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "elements/element_parts.h"
#include "elements/element_roots.h"
#include "radiosity/names.h"
#include "radiosity/report_line.h"
#include "radiosity/results.h"
#include "radiosity/row_matrix.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity::sample {

inline Scene scene() {
  Scene s;
  s.file = "d\xc3\xa4t\xc3\xa4/room one.obj";
  s.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-300}, {0, 1, 0.1}, {1e6, -3, 0.3}};
  s.face_offset = {0, 4, 7};
  s.corners = {0, 1, 2, 3, 0, 2, 4};
  s.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.1, 0.2}, {0.3, 0.4}, {-7, 1. / 3}};
  s.colours.assign(7, Vec3(1.0));
  s.colours[3] = {0.25, 1. / 3, 0};
  s.face_surface = {1, 0};
  s.face_element = {17, 12345678901};
  s.surfaces = {{"box", 1, "box/red"}, {"", 0, "/white"}};
  s.materials.resize(2);
  s.materials[0].name = "white";
  s.materials[0].texture = 1;
  s.materials[1] = {"red", {0.5, 1. / 3, 0.1}, {17, 12, 4}, true, kNone, 0};
  s.textures.push_back({"one.png", 2, 1, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 1.f}, false});
  s.textures.push_back({"two.png", 40, 30, std::vector<float>(40 * 30 * 3, 0.25f), true});
  s.cameras = {{"front", {1, 2, 3}, {4, 5, 6}, {0, 0, 1}, 0.6, 1.5}, {}};
  s.lights = {uniformSky({0.1, 1, 1e9})};
  s.lights[0].photometric = true;
  s.up = Up::z;
  s.unit = "mm";
  s.notes = {{Severity::loud, "lamp: emits by inheritance"}, {Severity::info, ""}};
  return s;
}

/// A plane of side x side unit squares in two surfaces; the first square is two-sided (its back is
/// the last patch), the second has no area. Not the mesh of scene(): only the file cares.
inline PatchMesh mesh(Index side) {
  PatchMesh m;
  for (Index y = 0; y <= side; ++y) {
    for (Index x = 0; x <= side; ++x) m.vertices.push_back({x, y, 0.1 * x * y});
  }
  m.surface_names = {"box/red", "/white"};
  m.corner_offset = {0};
  m.piece_offset = {0};
  const auto add = [&](std::vector<Index> corners, double area, Index surface, bool back) {
    const auto k = Index(m.size());
    m.pieces.push_back({corners[0], corners[1], corners[2]});
    m.pieces.push_back({corners[0], corners[2], corners[3]});
    if (area == 0) m.pieces.resize(m.piece_offset.back());
    m.piece_offset.push_back(m.pieces.size());
    m.corners.insert(m.corners.end(), corners.begin(), corners.end());
    m.corner_offset.push_back(m.corners.size());
    Vec3 centre(0.0);
    for (const Index v : corners) centre += 0.25 * m.vertices[v];
    m.centroid.push_back(centre);
    m.normal.push_back(area > 0 ? Vec3(0, 0, back ? -1 : 1) : Vec3(0.0));
    m.area.push_back(area);
    m.polygon.push_back(area > 0 ? surface : kNone);
    m.surface.push_back(surface);
    m.index_in_surface.push_back(k);
    m.source_face.push_back(surface);
    m.side.push_back(back ? 1 : 0);
    m.twin.push_back(kNone);
  };
  for (Index y = 0; y < side; ++y) {
    for (Index x = 0; x < side; ++x) {
      const Index v = y * (side + 1) + x;
      add({v, v + 1, v + side + 2, v + side + 1}, x + y * side == 1 ? 0 : 1 + 1. / (x + 3),
          2 * y < side ? 0 : 1, false);
    }
  }
  add({side + 1, side + 2, 1, 0}, m.area[0], 0, true);
  m.twin[0] = Index(m.size() - 1);
  m.twin.back() = 0;
  PlanarPolygons& p = m.polygons;
  const Index top = side * (side + 1);
  p.loop_offset = {0, 1, 2};
  p.corner_offset = {0, 4, 7};
  p.corners = {0, side, top + side, top, 0, side, top};
  p.normal = {{0, 0, 1}, {0, 1, 0}};
  p.origin = {{0, 0, 0}, {0.5, 0.25, 0.125}};
  p.surface = {0, 1};
  p.index_in_surface = {1, 0};
  p.back_is_patch = {1, 0};
  return m;
}

/// Fills the figures of a report, each differently.
class Filled {
 public:
  Filled(double first, int bands) : next_(first), bands_(bands) {}
  template <class T>
  void operator()(const ReportLine& line, T& value) {
    next_ += 1.25;
    if constexpr (std::is_enum_v<T>) {
      value = tableOf(value).back().first;
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = line.name;
    } else if constexpr (std::is_same_v<T, bool>) {
      value = true;
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      value.assign(std::size_t(bands_), next_);
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = T(next_);
    } else {
      (*this)(line, value.emplace());
    }
  }
  void part(const char* /*name*/, auto& report) { report.describe(*this, report); }
  void table(const char* /*name*/, const auto& /*records*/, const auto& /*columns*/) {}
  void notes(std::vector<Note>& notes) { notes = {{Severity::warning, "left wall: by 3.2 mm"}}; }

 private:
  double next_;
  int bands_;
};

template <class Report>
void fill(Report& report, double first, int bands = 3) {
  Filled fields(first, bands);
  Report::describe(fields, report);
}

inline MeshReport meshReport() {
  MeshReport r;
  fill(r, 0);
  r.surfaces = {{"box/red", 1, 2, 3, 4, 5}, {"/white", 0.1, 0.2, 0.3, 0.4, 0.5}};
  return r;
}

/// Rows of all kinds: empty (patch 1), sparse, and, from patch 2 on every fifth, full.
inline std::shared_ptr<const RowMatrix> matrix(const PatchMesh& m, Precision precision) {
  auto f = std::make_shared<RowMatrix>(m.area, precision);
  const std::size_t n = m.size();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(1e-9, 1.0 / double(n));
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (Index j = 0; j < n && i != 1; ++j) {
      if (j == i || (i % 5 != 2 && random() % 16 != 0)) continue;
      columns.push_back(j);
      values.push_back(value(random));
    }
    f->setRow(i, columns, values);
  }
  return f;
}

/// The same kinds of rows, reciprocal, stored in an order of its own.
inline std::shared_ptr<const SymmetricMatrix> symmetricMatrix(const PatchMesh& m,
                                                              Precision precision) {
  const std::size_t n = m.size();
  std::mt19937 random(11);
  std::vector<Index> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = Index(k);
  std::shuffle(order.begin(), order.end(), random);
  auto f = std::make_shared<SymmetricMatrix>(m.area, order, precision);
  std::uniform_real_distribution<double> value(1e-9, 1.0 / double(n));
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> row(n - k, 0.0);
    for (std::size_t q = 0; q < row.size() && k != 1; ++q) {
      if (m.area[order[k]] == 0 || m.area[order[k + q]] == 0) continue;
      if (k % 5 == 2 || random() % 16 == 0) row[q] = value(random);
    }
    f->setUpperRow(k, row);
  }
  return f;
}

inline FormFactors factors(const PatchMesh& m, Precision precision) {
  FormFactors f;
  f.matrix = matrix(m, precision);
  f.fronts = f.matrix->rowSums();
  for (std::size_t i = 0; i < m.size(); ++i) {
    f.backs.push_back(1.0 / double(i + 3));
    f.sky.push_back(1.0 - 1.0 / double(i + 3) - f.fronts[i]);
    f.error.push_back(1e-6 / double(i + 1));
  }
  f.backs_by_surface = {0.001, 0.25};
  f.method = FormFactorMethod::hemicube;
  fill(f.report, 100);
  fill(f.report.hemicube, 9e9);
  return f;
}

inline Solution solution(std::size_t n, int bands) {
  Solution s;
  s.bands = bands;
  for (std::size_t k = 0; k < n * std::size_t(bands); ++k) {
    s.radiosity.push_back(std::sqrt(double(k)));
    s.irradiance.push_back(std::cbrt(double(k)) * 1e-200);
  }
  fill(s.summary, 200, bands);
  return s;
}

inline PatchMaterials materials(std::size_t n, int bands) {
  PatchMaterials m;
  m.bands = bands;
  for (std::size_t k = 0; k < n * std::size_t(bands); ++k) {
    m.reflectance.push_back(1.0 / double(k + 3));
    m.emission.push_back(1e-9 * double(k));
  }
  m.lights = {uniformSky({})};
  for (int b = 0; b < bands; ++b) m.lights[0].strength.push_back(0.25 * double(b) + 0.1);
  return m;
}

/// A field whose first root is cut in four, its second one tested, its third left out.
inline ElementField elementField(const ElementRoots& roots, int bands, double scale) {
  ElementField f;
  f.elements.resize(roots.size());
  const auto place = [&](std::size_t e, std::size_t corners, const std::vector<Index>& points) {
    f.elements[e].corners = std::uint8_t(corners);
    f.elements[e].first_point = Index(f.points.size());
    f.elements[e].tested = points.size() > corners ? 1 : 0;
    f.points.insert(f.points.end(), points.begin(), points.end());
  };
  const auto fresh = [&](std::size_t count) {
    std::vector<Index> points;
    while (points.size() < count) points.push_back(Index(f.vertices++));
    return points;
  };
  for (std::size_t r = 0; r < roots.size(); ++r) {
    const std::size_t n = roots.cornerCount(r);
    if (r != 2) place(r, n, fresh(pointCount(n, r < 2)));
  }
  if (roots.size() == 0) return f;
  f.elements[0].first_child = Index(f.elements.size());
  const std::size_t n = f.elements[0].corners;
  for (const PartCorners& part : partsOf(n)) {
    std::vector<Index> points;
    for (std::size_t k = 0; k < n; ++k) points.push_back(f.points[part[k]]);
    f.elements.emplace_back();
    place(f.elements.size() - 1, n, points);
  }
  for (std::size_t k = 0; k < f.vertices * std::size_t(bands); ++k) {
    f.values.push_back(scale * std::sqrt(double(k + 2)));
  }
  return f;
}

inline Elements elements(const PatchMesh& mesh, int bands) {
  Elements e;
  e.bands = bands;
  e.roots = elementRoots(mesh);
  e.direct = elementField(e.roots, bands, 1e-200);
  e.indirect = elementField(e.roots, bands, 1.0 / 3);
  fill(e.report, 300);
  return e;
}

inline Gathered gathered(const PatchMesh& mesh, GatherAt at, int bands) {
  Gathered g;
  g.at = at;
  g.bands = bands;
  const std::size_t eyes = at == GatherAt::patches ? mesh.size() : mesh.corners.size();
  for (std::size_t k = 0; k < eyes; ++k) {
    for (int b = 0; b < bands; ++b) {
      g.radiosity.push_back(std::sqrt(float(k) + 0.1F * float(b)));
      g.irradiance.push_back(1e-30F * float(k) + float(b));
    }
    g.backs.push_back(0.25F / float(k + 1));
    g.sky.push_back(0.125F / float(k + 1));
    g.area.push_back(1.0 / double(k + 3));
    g.position.push_back({double(k), 0.1, -1.0 / 3});
  }
  for (std::size_t k = 0; k < mesh.surface_names.size(); ++k) {
    g.backs_by_surface.push_back(0.3 / double(k + 1));
  }
  if (at == GatherAt::vertices) {
    for (std::size_t k = 0; k < eyes; ++k) g.eye_of_corner.push_back(Index(eyes - 1 - k));
  }
  fill(g.summary, 1e10);
  g.summary.passes.resize(2);
  for (GatherPass& pass : g.summary.passes) fill(pass, 400, bands);
  g.summary.passes[0].bound.reset();
  return g;
}

inline HeatSolution heat(const PatchMesh& mesh, int bands) {
  HeatSolution h;
  h.bands = bands;
  for (std::size_t k = 0; k < mesh.size(); ++k) {
    for (int b = 0; b < bands; ++b) {
      h.radiosity.push_back(std::sqrt(double(k) + 0.2 * b));
      h.irradiance.push_back(1e-30 * double(k) + b);
    }
    h.net_flux.push_back(0.3 - double(k));
    h.convection.push_back(1.0 / (double(k) + 3));
    h.temperature.push_back(300 + 1.0 / (double(k) + 1));
  }
  fill(h.summary, 500);
  fill(h.summary.balance, 600);
  h.conditions = {
      "", "surface,emissivity\r\n# ä\n*,0.5\n", {"lamp.temperature=900", "*.flux=0"}, {"all=*"}};
  return h;
}

inline LightBasis basis(std::size_t n, int bands) {
  LightBasis l;
  l.names = {"lamp", "a name, with a comma", "sky"};
  l.bands = bands;
  l.materials = materials(n, 3 * bands);
  l.solution = solution(n, 3 * bands);
  return l;
}

inline Results results(Index side, Precision precision, int bands = 3) {
  Results r;
  r.version = "0.1.0";
  r.scene = scene();
  r.mesh = {MeshResult{mesh(side), meshReport()}, "patches=100"};
  r.factors = {factors(r.mesh->mesh, precision), "patches=100 resolution=256"};
  const std::size_t n = r.mesh->mesh.size();
  r.materials = materials(n, bands);
  r.solution = {solution(n, bands), "tolerance=1e-6"};
  r.elements = {elements(r.mesh->mesh, bands), "element-tolerance=0.01"};
  // Both kinds, one in each sample.
  const GatherAt at =
      precision == Precision::single_precision ? GatherAt::patches : GatherAt::vertices;
  r.gathered = {gathered(r.mesh->mesh, at, bands), "passes=2"};
  r.heat = {heat(r.mesh->mesh, bands), "sky-temperature=3"};
  r.basis = {basis(n, bands), "solver=cg reflectance=12ab"};
  return r;
}

/// The figures of a report, to the bit.
class Figures {
 public:
  bool operator==(const Figures&) const = default;
  template <class T>
  void operator()(const ReportLine& line, const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      all_.push_back(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      all_.emplace_back(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(double));
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      all_.emplace_back(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      all_.emplace_back(value ? "there" : "missing");
      if (value) (*this)(line, *value);
    }
  }
  void part(const char* /*name*/, const auto& report) { report.describe(*this, report); }
  void table(const char* /*name*/, const auto& records, const auto& columns) {
    const auto column = [&](const char* name, auto member, const char* /*unit*/ = "") {
      for (const auto& record : records) (*this)(ReportLine{name}, record.*member);
    };
    columns(column);
  }
  void notes(const std::vector<Note>& notes) {
    for (const Note& note : notes) {
      (*this)(ReportLine{"severity"}, note.severity);
      all_.push_back(note.text);
    }
  }

 private:
  std::vector<std::string> all_;
};

template <class Report>
Figures figures(const Report& report) {
  Figures list;
  Report::describe(list, report);
  return list;
}

// Every struct as the tuple of its members, reports by what they describe. A structured binding
// must name all members: one added to a struct stops this from compiling until file and comparison
// know it.
inline auto members(const Note& s) {
  const auto& [a, b] = s;
  return std::tie(a, b);
}
inline auto members(const Texture& s) {
  const auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto members(const Material& s) {
  const auto& [a, b, c, d, e, f] = s;
  return std::tie(a, b, c, d, e, f);
}
inline auto members(const Surface& s) {
  const auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto members(const Camera& s) {
  const auto& [a, b, c, d, e, f] = s;
  return std::tie(a, b, c, d, e, f);
}
inline auto members(const Light& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto members(const Scene& s) {
  const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
}
inline auto members(const PlanarPolygons& s) {
  const auto& [a, b, c, d, e, f, g, h] = s;
  return std::tie(a, b, c, d, e, f, g, h);
}
inline auto members(const PatchMesh& s) {
  // Enclosures are not kept in the file: they are found anew.
  const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, enclosures] = s;
  static_cast<void>(enclosures);
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
}
inline auto members(const MeshResult& s) {
  const auto& [a, b] = s;
  return std::tie(a, b);
}
inline auto members(const FormFactorReport& s) {
  return std::make_tuple(figures(s), figures(s.hemicube));
}
inline auto members(const FormFactors& s) {
  const auto& [a, b, c, d, e, f, g, h] = s;
  return std::tie(a, b, c, d, e, f, g, h);
}
inline auto members(const PatchMaterials& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto members(const Solution& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto members(const GatherSummary& s) { return std::make_tuple(figures(s), s.passes); }
inline auto members(const ElementRoots& s) {
  const auto& [a, b, c] = s;
  return std::tie(a, b, c);
}
inline auto members(const Element& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto members(const ElementField& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
inline auto members(const Elements& s) {
  const auto& [a, b, c, d, e] = s;
  return std::tie(a, b, c, d, e);
}
inline auto members(const Gathered& s) {
  const auto& [a, b, c, d, e, f, g, h, i, j, k] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j, k);
}
inline auto members(const HeatSummary& s) {
  return std::make_tuple(figures(s), figures(s.balance));
}
inline auto members(const ConditionText& s) {
  // Its source is not kept in the file.
  return std::tie(s.table, s.settings);
}
inline auto members(const HeatSolution& s) {
  const auto& [a, b, c, d, e, f, g, h] = s;
  return std::tie(a, b, c, d, e, f, g, h);
}
inline auto members(const LightBasis& s) {
  const auto& [a, b, c, d] = s;
  return std::tie(a, b, c, d);
}
template <class T>
auto members(const Keyed<T>& s) {
  const auto& [a, b] = s;
  return std::tie(a, b);
}
inline auto members(const Results& s) {
  const auto& [a, b, c, d, e, f, g, h, i, j] = s;
  return std::tie(a, b, c, d, e, f, g, h, i, j);
}

template <class T>
bool same(const T& a, const T& b);
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!same(a[k], b[k])) return false;
  }
  return true;
}
template <class T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
/// Value for value to the bit, stored alike.
inline bool same(const ExchangeMatrix& a, const ExchangeMatrix& b) {
  if (a.size() != b.size() || a.precision() != b.precision() ||
      !std::equal(a.order().begin(), a.order().end(), b.order().begin(), b.order().end()) ||
      a.nonZeros() != b.nonZeros() || a.bytes() != b.bytes()) {
    return false;
  }
  using Entries = std::vector<std::pair<Index, double>>;
  for (std::size_t i = 0; i < a.size(); ++i) {
    Entries left;
    Entries right;
    a.forRow(i, [&](Index j, double f) { left.emplace_back(j, f); });
    b.forRow(i, [&](Index j, double f) { right.emplace_back(j, f); });
    if (left != right || a.area()[i] != b.area()[i]) return false;
  }
  return true;
}
inline bool same(const std::shared_ptr<const ExchangeOperator>& a,
                 const std::shared_ptr<const ExchangeOperator>& b) {
  return a == b || (a && b && same(pairsOf(*a), pairsOf(*b)));
}
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (requires { members(a); }) {
    const auto left = members(a);
    const auto right = members(b);
    return [&]<std::size_t... K>(std::index_sequence<K...>) {
      return (same(std::get<K>(left), std::get<K>(right)) && ...);
    }(std::make_index_sequence<std::tuple_size_v<decltype(left)>>{});
  } else if constexpr (requires(Figures list) { T::describe(list, a); }) {
    return figures(a) == figures(b);
  } else {
    return a == b;
  }
}

}  // namespace radiosity::sample
