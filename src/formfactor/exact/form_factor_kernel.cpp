#include "radiosity/form_factor_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

#include "formfactor/exact/sensor_view.h"
#include "formfactor/exact/unoccluded/quadrature.h"

namespace radiosity {

static_assert(FormFactorKernel::kMostPoints == kMostGaussNodes);

struct FormFactorKernel::Prepared {
  Prepared(const PatchMesh& mesh, int points_a_side, Progress& progress)
      : view(mesh, progress), points(points_a_side), first_element(mesh.size() + 1) {
    const ElementSet& elements = view.elements();
    for (std::size_t e = 0; e < elements.patch_elements; ++e)
      ++first_element[elements.patch[e] + 1];
    for (std::size_t i = 0; i < mesh.size(); ++i) first_element[i + 1] += first_element[i];
    element.resize(elements.patch_elements);
    std::vector<std::size_t> next(first_element.begin(), first_element.end() - 1);
    for (std::size_t e = 0; e < elements.patch_elements; ++e) {
      element[next[elements.patch[e]]++] = Index(e);
    }
  }

  std::size_t size() const { return first_element.size() - 1; }
  std::span<const Index> elementsOf(Index patch) const {
    return std::span(element).subspan(first_element[patch],
                                      first_element[patch + 1] - first_element[patch]);
  }

  /// Calls at(sensor, weight) for the Gauss points of an element; weights sum to its area.
  template <class At>
  void visitPoints(Index e, const At& at) const {
    const ElementSet& elements = view.elements();
    const auto& c = elements.corners[e];
    const Vec3& normal = elements.facets[elements.facet[e]].normal;
    // A triangle is a quadrilateral whose last two corners meet (Duffy 1982).
    for (const Node& u : gaussLegendre(points)) {
      for (const Node& v : gaussLegendre(points)) {
        const double s = (1 + u.x) / 2;
        const double t = (1 + v.x) / 2;
        const Vec3 at_bottom = glm::mix(c[0], c[1], s);
        const Vec3 at_top = glm::mix(c[3], c[2], s);
        const Vec3 along = glm::mix(c[1] - c[0], c[2] - c[3], t);
        const double stretch = glm::length(glm::cross(along, at_top - at_bottom));
        at(view.placed(glm::mix(at_bottom, at_top, t), normal), stretch * u.weight * v.weight / 4);
      }
    }
  }

  /// Adds `weight` times the form factor from a sensor to each column's patch.
  void look(const Sensor& sensor, double weight, std::span<const Index> columns,
            std::span<double> values) const {
    const ElementSet& elements = view.elements();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (const Index e : elementsOf(columns[c])) {
        const Facet& facet = elements.facets[elements.facet[e]];
        if (view.faces(sensor, facet)) values[c] += weight * view.visible(sensor, facet, e);
      }
    }
  }

  SensorView view;
  int points;
  std::vector<std::size_t> first_element;  ///< N + 1, into element
  std::vector<Index> element;              ///< by patch
};

FormFactorKernel::FormFactorKernel(const PatchMesh& mesh, int points, Progress& progress) {
  if (points < 1 || points > kMostPoints) {
    throw InputError(fmt::format("form-factor kernel: {} points along a side; give 1 to {}", points,
                                 kMostPoints));
  }
  prepared_ = std::make_unique<const Prepared>(mesh, points, progress);
}

FormFactorKernel::~FormFactorKernel() = default;
FormFactorKernel::FormFactorKernel(FormFactorKernel&&) noexcept = default;
FormFactorKernel& FormFactorKernel::operator=(FormFactorKernel&&) noexcept = default;

std::size_t FormFactorKernel::size() const { return prepared_->size(); }

void FormFactorKernel::block(std::span<const Index> rows, std::span<const Index> columns,
                             std::span<double> values) const {
  if (values.size() != rows.size() * columns.size()) {
    throw InputError(fmt::format("form-factor kernel: a block of {} x {} has room for {} values",
                                 rows.size(), columns.size(), values.size()));
  }
  for (const auto& [what, chosen] : {std::pair("row", rows), std::pair("column", columns)}) {
    for (const Index i : chosen) {
      if (i < size()) continue;
      throw InputError(
          fmt::format("form-factor kernel: {} {}: there are {} patches", what, i, size()));
    }
  }
  std::fill(values.begin(), values.end(), 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::span<double> row = values.subspan(r * columns.size(), columns.size());
    double area = 0;
    for (const Index e : prepared_->elementsOf(rows[r])) {
      prepared_->visitPoints(e, [&](const Sensor& sensor, double weight) {
        area += weight;
        prepared_->look(sensor, weight, columns, row);
      });
    }
    if (area > 0)
      std::transform(row.begin(), row.end(), row.begin(), [&](double v) { return v / area; });
  }
}

}  // namespace radiosity
