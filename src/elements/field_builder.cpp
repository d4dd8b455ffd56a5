#include "elements/field_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/parallel.h"
#include "elements/element_parts.h"
#include "elements/mean_lift.h"

namespace radiosity {
namespace {

using Lights = std::shared_ptr<const ElementLights>;

/// The share of an edge's interpolation error that remains once its two halves have values: errors
/// of linear interpolation fall with the square of the length. At kinks they fall only with the
/// length, but elements are usually cut there.
constexpr double kHalvedError = 0.25;

/// An element that is being refined.
struct Node {
  Index element = 0;
  Index root = 0;
  std::array<Index, 4> vertex{};
  std::array<Index, 4> tag{};  ///< of its edges
  Lights lights;
  double error = 0;  ///< largest interpolation error over the light there
  bool tested = false;
  bool wants_cut = false;
  bool forced = false;

  std::size_t corners() const { return vertex[3] == kNone ? 3 : 4; }
};

class FieldBuilder {
 public:
  FieldBuilder(const PatchMesh& mesh, const ElementSurface& surface, const FieldLight& light,
               const RefinementRule& rule, int bands, const std::string& stage, Progress& progress)
      : mesh_(mesh),
        surface_(surface),
        light_(light),
        rule_(rule),
        bands_(std::size_t(bands)),
        stage_(stage),
        progress_(progress),
        points_(surface.points),
        edges_(surface.edges),
        most_points_(points_.size() + rule.most_vertices) {}

  FieldSummary build() {
    std::vector<Node> nodes = roots();
    evaluateCorners(nodes);
    while (!nodes.empty()) {
      progress_.check();
      addTests(nodes);
      evaluateNew();
      judge(nodes);
      limit(nodes);
      if (rule_.keep_lights) keepLights(nodes);
      nodes = cut(nodes);
    }
    liftToMeans(out_.field, points_, lightAtVertices(), bands_);
    conform();
    measure();
    out_.field.vertices = points_.size();
    return std::move(out_);
  }

 private:
  const SurfacePoint& point(Index v) const { return points_[v]; }
  double* value(Index v) { return out_.field.values.data() + v * bands_; }

  RootUse useOf(Index root) const { return rule_.use.empty() ? RootUse::shown : rule_.use[root]; }
  bool isShown(Index root) const { return useOf(root) == RootUse::shown; }
  bool isLeftOut(Index root) const {
    return rule_.shown_alone ? !isShown(root) : useOf(root) == RootUse::none;
  }

  double edgeOf(const Node& node) const {
    double longest = 0;
    const std::size_t n = node.corners();
    for (std::size_t k = 0; k < n; ++k) {
      longest = std::max(longest, glm::distance(point(node.vertex[k]).place,
                                                point(node.vertex[(k + 1) % n]).place));
    }
    return longest;
  }

  ElementShape shapeOf(const Node& node) const {
    ElementShape shape;
    shape.root = node.root;
    for (std::size_t k = 0; k < 4; ++k) {
      shape.corners[k] = point(node.vertex[std::min(k, node.corners() - 1)]).place;
    }
    return shape;
  }

  std::vector<Node> roots() {
    const std::size_t count = surface_.roots.size();
    std::vector<Node> nodes(count);
    out_.field.elements.resize(count);
    root_of_.resize(count);
    std::iota(root_of_.begin(), root_of_.end(), Index(0));
    progress_.begin(fmt::format("{}, preparing", stage_), count, "elements");
    parallelFor(count, 16, [&](std::size_t r) {
      progress_.advance();
      Node& node = nodes[r];
      node.element = node.root = Index(r);
      if (progress_.cancelled() || isLeftOut(node.root)) return;
      node.vertex = surface_.vertex[r];
      node.tag = surface_.tag[r];
      node.lights = light_.lightsOf(shapeOf(node), nullptr);
    });
    progress_.check();
    std::erase_if(nodes, [&](const Node& node) { return isLeftOut(node.root); });
    return nodes;
  }

  /// Evaluates the corners of roots, each by the first root that has it.
  void evaluateCorners(const std::vector<Node>& nodes) {
    pending_.assign(points_.size(), {});
    for (const Node& node : nodes) {
      for (std::size_t k = 0; k < node.corners(); ++k) {
        if (pending_[node.vertex[k]].vertex == kNone) {
          pending_[node.vertex[k]] = {node.vertex[k], node.root, node.lights};
        }
      }
    }
    std::erase_if(pending_, [](const Pending& p) { return p.vertex == kNone; });
    evaluateNew();
  }

  void evaluateNew() {
    out_.field.values.resize(points_.size() * bands_, 0.0);
    noise_.resize(points_.size(), 0.0);
    out_.evaluated += pending_.size();
    progress_.begin(fmt::format("{}, round {}", stage_, ++round_), pending_.size(), "points");
    parallelFor(pending_.size(), 16, [&](std::size_t k) {
      if (progress_.cancelled()) return;
      progress_.advance();
      const auto& [v, root, lights] = pending_[k];
      if (lights && lights->kind == ElementLights::Kind::dark) return;
      const double noise = light_.irradiance(points_[v], lights.get(), {value(v), bands_});
      noise_[v] = std::max(0.0, noise);
      if (noise >= 0 || rule_.patch_light.empty()) return;
      const std::size_t patch = surface_.roots.patch[root];
      std::copy_n(rule_.patch_light.data() + patch * bands_, bands_, value(v));
    });
    pending_.clear();
    progress_.check();
    progress_.end();
  }

  bool isDark(const Node& node) const {
    return node.lights && node.lights->kind == ElementLights::Kind::dark;
  }

  double brightness(Index v) {
    double sum = 0;
    for (std::size_t b = 0; b < bands_; ++b) sum += std::abs(value(v)[b]);
    return sum;
  }

  /// The difference between the brightest and the darkest corner, over the light there.
  double spreadOf(const Node& node) {
    double low = brightness(node.vertex[0]);
    double high = low;
    for (std::size_t k = 1; k < node.corners(); ++k) {
      low = std::min(low, brightness(node.vertex[k]));
      high = std::max(high, brightness(node.vertex[k]));
    }
    return (high - low) / lightAt(node, high);
  }

  double lightAt(const Node& node, double own) const {
    return std::max(own + rule_.other_light[surface_.roots.patch[node.root]], rule_.least_light);
  }

  /// The light of both fields at each vertex, over all bands.
  std::vector<double> lightAtVertices() {
    std::vector<double> light(points_.size(), 0.0);
    for (std::size_t e = 0; e < out_.field.elements.size(); ++e) {
      const Element& element = out_.field.elements[e];
      const Index* p = out_.field.points.data() + element.first_point;
      const double other = rule_.other_light[surface_.roots.patch[root_of_[e]]];
      for (std::size_t k = 0; k < pointCount(element.corners, element.tested != 0); ++k) {
        light[p[k]] = std::max(other + brightness(p[k]), rule_.least_light);
      }
    }
    return light;
  }

  /// Writes the elements' points, and adds vertices in the middles of those that are tested.
  void addTests(std::vector<Node>& nodes) {
    for (Node& node : nodes) {
      Element& element = out_.field.elements[node.element];
      const std::size_t n = node.corners();
      element.corners = std::uint8_t(n);
      element.first_point = Index(out_.field.points.size());
      const double edge = edgeOf(node);
      const bool partial = node.lights && node.lights->kind == ElementLights::Kind::partial;
      node.forced = edge > rule_.longest_edge || (partial && edge > rule_.partial_edge);
      const double smallest = isShown(node.root) ? rule_.smallest_edge : rule_.source_edge;
      const double found = spreadOf(node);
      const bool steep = found > rule_.steep_spread && isShown(node.root) &&
                         edge > rule_.steep_fraction * smallest;
      node.tested = !isDark(node) &&
                    ((edge > smallest && (node.forced || found >= rule_.least_spread)) || steep);
      if (rule_.like != nullptr) {
        node.tested = rule_.like->elements[node.element].tested != 0;
      } else if (node.tested && points_.size() + 5 > most_points_) {
        node.tested = false;
        ++out_.unrefined;
      }
      element.tested = node.tested ? 1 : 0;
      for (std::size_t k = 0; k < n; ++k) out_.field.points.push_back(node.vertex[k]);
      if (!node.tested) continue;
      for (std::size_t k = 0; k < n; ++k) out_.field.points.push_back(middleOf(node, k));
      if (n == 4) out_.field.points.push_back(centreOf(node));
    }
  }

  Index addPoint(const SurfacePoint& fresh, const Node& node) {
    points_.push_back(fresh);
    const auto v = Index(points_.size() - 1);
    pending_.push_back({v, node.root, node.lights});
    return v;
  }

  Vec3 normalBetween(const Vec3& sum, const Node& node) const {
    const double length = glm::length(sum);
    return length > 0 ? sum / length : mesh_.normal[surface_.roots.patch[node.root]];
  }

  Index middleOf(const Node& node, std::size_t k) {
    const Index a = node.vertex[k];
    const Index b = node.vertex[(k + 1) % node.corners()];
    SurfaceEdge inner;
    inner.owners = mesh_.polygon[surface_.roots.patch[node.root]];
    SurfaceEdge& edge = edges_.edge(a, b, node.tag[k], inner);
    if (edge.middle != kNone) return edge.middle;
    SurfacePoint middle;
    middle.place = 0.5 * (points_[a].place + points_[b].place);
    middle.position = middle.place + edge.inset;
    middle.inner = middle.place + edge.inner;
    middle.normal = points_[a].normal == points_[b].normal
                        ? points_[a].normal
                        : normalBetween(points_[a].normal + points_[b].normal, node);
    middle.owners = edge.owners;
    const Index v = edge.middle = addPoint(middle, node);
    const SurfaceEdge half{kNone, edge.owners, edge.inset, edge.inner};
    edges_.edge(a, v, 0, half);
    edges_.edge(v, b, 0, half);
    return v;
  }

  Index centreOf(const Node& node) {
    SurfacePoint centre;
    Vec3 normal(0.0);
    for (const Index v : node.vertex) {
      centre.place += 0.25 * points_[v].place;
      normal += points_[v].normal;
    }
    centre.position = centre.inner = centre.place;
    centre.normal = normalBetween(normal, node);
    centre.owners = mesh_.polygon[surface_.roots.patch[node.root]];
    return addPoint(centre, node);
  }

  /// Sets the largest interpolation error between corners, over the light there, and decides which
  /// elements to cut.
  void judge(std::vector<Node>& nodes) {
    parallelFor(nodes.size(), 64, [&](std::size_t i) {
      Node& node = nodes[i];
      node.error = 0;
      node.wants_cut =
          rule_.like != nullptr && rule_.like->elements[node.element].first_child != kNone;
      if (rule_.like != nullptr || !node.tested) return;
      const Element& element = out_.field.elements[node.element];
      const Index* p = out_.field.points.data() + element.first_point;
      const std::size_t n = node.corners();
      double own = 0;
      for (std::size_t k = 0; k < pointCount(n, true); ++k) {
        own = std::max(own, brightness(p[k]));
      }
      const double light = lightAt(node, own);
      for (std::size_t k = 0; k < n; ++k) {
        double off = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
          off += std::abs(value(p[n + k])[b] - 0.5 * (value(p[k])[b] + value(p[(k + 1) % n])[b]));
        }
        node.error = std::max(node.error, off / light);
      }
      if (n == 4) {
        double off = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
          off += std::abs(value(p[8])[b] - 0.25 * (value(p[0])[b] + value(p[1])[b] +
                                                   value(p[2])[b] + value(p[3])[b]));
        }
        node.error = std::max(node.error, off / light);
      }
      node.wants_cut = node.forced || node.error > rule_.steep_spread ||
                       node.error * edgeOf(node) / rule_.reference_edge > rule_.tolerance;
    });
  }

  /// If all cuts would take more vertices than allowed, cuts only the elements with the largest
  /// errors.
  void limit(std::vector<Node>& nodes) {
    if (rule_.like != nullptr) return;
    constexpr std::size_t kNewVertices = 16;  // of four tested children, at most
    std::vector<Index> wanting;
    for (Index k = 0; k < nodes.size(); ++k) {
      if (nodes[k].wants_cut) wanting.push_back(k);
    }
    const std::size_t most = (most_points_ - points_.size()) / kNewVertices;
    if (wanting.size() <= most) return;
    std::sort(wanting.begin(), wanting.end(), [&](Index a, Index b) {
      const double first = nodes[a].error * edgeOf(nodes[a]);
      const double second = nodes[b].error * edgeOf(nodes[b]);
      return first != second ? first > second : a < b;
    });
    for (std::size_t k = most; k < wanting.size(); ++k) nodes[wanting[k]].wants_cut = false;
    out_.unrefined += wanting.size() - most;
  }

  void keepLights(const std::vector<Node>& nodes) {
    out_.lights.resize(out_.field.elements.size());
    for (const Node& node : nodes) {
      if (!node.wants_cut) out_.lights[node.element] = node.lights;
    }
  }

  std::vector<Node> cut(const std::vector<Node>& nodes) {
    std::vector<Node> children;
    std::vector<Lights> parents;
    for (const Node& node : nodes) {
      if (!node.wants_cut) continue;
      const Index* p = out_.field.points.data() + out_.field.elements[node.element].first_point;
      out_.field.elements[node.element].first_child = Index(out_.field.elements.size());
      for (const PartCorners& part : partsOf(node.corners())) {
        Node child;
        child.element = Index(out_.field.elements.size());
        child.root = node.root;
        for (std::size_t k = 0; k < 4; ++k) {
          child.vertex[k] = k < node.corners() ? p[part[k]] : kNone;
        }
        out_.field.elements.emplace_back();
        root_of_.push_back(node.root);
        children.push_back(std::move(child));
        parents.push_back(node.lights);
      }
    }
    parallelFor(children.size(), 16, [&](std::size_t k) {
      if (progress_.cancelled()) return;
      Node& child = children[k];
      const bool settled =
          parents[k] && (parents[k]->settled || parents[k]->kind == ElementLights::Kind::dark ||
                         parents[k]->kind == ElementLights::Kind::plain);
      child.lights = settled ? parents[k] : light_.lightsOf(shapeOf(child), parents[k].get());
    });
    progress_.check();
    return children;
  }

  /// Interpolates the vertices between a and b linearly.
  void straighten(Index a, Index b, Index tag) {
    const SurfaceEdge* edge = edges_.find(a, b, tag);
    if (edge == nullptr || edge->middle == kNone) return;
    const Index middle = edge->middle;
    for (std::size_t k = 0; k < bands_; ++k) {
      value(middle)[k] = 0.5 * (value(a)[k] + value(b)[k]);
    }
    straighten(a, middle, 0);
    straighten(middle, b, 0);
  }

  /// Sets values on edges to those of the coarser neighbour. Coarse elements come first, so that
  /// finer ones do not change these values again.
  void conform() {
    for (std::size_t e = 0; e < out_.field.elements.size(); ++e) {
      const Element& element = out_.field.elements[e];
      if (element.first_child != kNone || element.corners == 0 || !isShown(root_of_[e])) continue;
      const Index* p = out_.field.points.data() + element.first_point;
      const std::size_t n = element.corners;
      const bool root = e < surface_.roots.size();
      for (std::size_t k = 0; k < n; ++k) {
        const Index a = p[k];
        const Index b = p[(k + 1) % n];
        if (element.tested == 0) {
          straighten(a, b, root ? surface_.tag[e][k] : 0);
        } else {
          straighten(a, p[n + k], 0);
          straighten(p[n + k], b, 0);
        }
      }
    }
  }

  /// Sums the errors over all leaves.
  void measure() {
    out_.shortest_edge = surface_.diagonal;
    for (Index e = 0; e < out_.field.elements.size(); ++e) {
      const Element& element = out_.field.elements[e];
      if (element.first_child == kNone && element.corners != 0 && isShown(root_of_[e])) {
        measureLeaf(element, root_of_[e]);
      }
    }
  }

  void measureLeaf(const Element& element, Index root) {
    const Index* p = out_.field.points.data() + element.first_point;
    const std::size_t n = element.corners;
    const Vec3 a = points_[p[0]].place;
    double area = 0.5 * glm::length(glm::cross(points_[p[1]].place - a, points_[p[2]].place - a));
    if (n == 4) {
      area += 0.5 * glm::length(glm::cross(points_[p[2]].place - a, points_[p[3]].place - a));
    }
    double own = 0;
    double noise = 0;
    for (std::size_t k = 0; k < n; ++k) {
      own += brightness(p[k]) / double(n);
      noise += noise_[p[k]] / double(n);
      const double edge = glm::distance(points_[p[k]].place, points_[p[(k + 1) % n]].place);
      out_.shortest_edge = std::min(out_.shortest_edge, edge / (element.tested != 0 ? 2 : 1));
    }
    double off = 0;
    if (element.tested != 0) {
      for (std::size_t k = 0; k < n; ++k) {
        const double straight = 0.5 * (brightness(p[k]) + brightness(p[(k + 1) % n]));
        off = std::max(off, std::abs(brightness(p[n + k]) - straight));
      }
    }
    const double light = own + rule_.other_light[surface_.roots.patch[root]];
    out_.interpolation_square += area * kHalvedError * kHalvedError * off * off;
    out_.noise_square += area * noise;
    out_.light_square += area * light * light;
    out_.area += area;
  }

  const PatchMesh& mesh_;
  const ElementSurface& surface_;
  const FieldLight& light_;
  const RefinementRule& rule_;
  std::size_t bands_;
  const std::string& stage_;
  std::size_t round_ = 0;
  Progress& progress_;
  std::vector<SurfacePoint> points_;
  EdgeMap edges_;
  std::size_t most_points_;
  std::vector<Index> root_of_;  ///< of each element
  std::vector<double> noise_;   ///< V
  /// A vertex to evaluate.
  struct Pending {
    Index vertex = kNone;
    Index root = 0;
    Lights lights;
  };
  std::vector<Pending> pending_;
  FieldSummary out_;
};

}  // namespace

FieldSummary buildField(const PatchMesh& mesh, const ElementSurface& surface,
                        const FieldLight& light, const RefinementRule& rule, int bands,
                        const std::string& stage, Progress& progress) {
  return FieldBuilder(mesh, surface, light, rule, bands, stage, progress).build();
}

}  // namespace radiosity
