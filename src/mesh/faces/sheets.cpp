#include "mesh/faces/sheets.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "base/union_find.h"
#include "mesh/edge_key.h"

namespace radiosity {

namespace {

/// Faces of one plane, surface and facing that run along one edge in either direction.
struct SharedEdge {
  std::vector<Index> forward;
  std::vector<Index> backward;

  /// Whether exactly two faces meet, so that the edge is inside a sheet.
  bool isInside() const { return forward.size() == 1 && backward.size() == 1; }
};

using SharedEdges = std::map<std::pair<Index, Index>, SharedEdge>;

SharedEdges sharedEdges(const InputFaces& input, const std::vector<Index>& faces) {
  SharedEdges out;
  for (const Index f : faces) {
    const auto& loop = input.faces[f].loop;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Index from = loop[k];
      const Index to = loop[(k + 1) % loop.size()];
      SharedEdge& edge = out[std::minmax(from, to)];
      (from < to ? edge.forward : edge.backward).push_back(f);
    }
  }
  return out;
}

/// The sheet of a lone triangle.
void addTriangle(const InputFaces& input, Index face, const Sheet& common,
                 std::vector<Sheet>& out) {
  const auto& loop = input.faces[face].loop;
  Sheet& sheet = out.emplace_back(common);
  sheet.faces = {face};
  sheet.edges = {{loop[0], loop[1]}, {loop[1], loop[2]}, {loop[2], loop[0]}};
  std::ranges::sort(sheet.edges, {}, [](const auto& edge) {
    return std::pair(std::min(edge[0], edge[1]), std::max(edge[0], edge[1]));
  });
  for (const Index v : loop) sheet.box.add(input.points[v]);
  sheet.coincidence = input.faces[face].coincidence;
}

/// Adds the sheets of faces that already agree in plane, surface and facing.
void addSheets(const InputFaces& input, const std::vector<Index>& faces, const Sheet& common,
               std::vector<Sheet>& out) {
  if (faces.size() == 1 && input.faces[faces[0]].loop.size() == 3) {
    return addTriangle(input, faces[0], common, out);
  }
  std::map<Index, Index> local;
  for (const Index f : faces) local.emplace(f, Index(local.size()));
  UnionFind together(faces.size());
  const SharedEdges edges = sharedEdges(input, faces);
  for (const auto& [ends, edge] : edges) {
    if (edge.isInside()) together.unite(local[edge.forward[0]], local[edge.backward[0]]);
  }
  std::map<Index, std::size_t> sheet_of;
  for (const Index f : faces) {
    const auto [it, added] = sheet_of.emplace(together.find(local[f]), out.size());
    if (added) out.push_back(common);
    Sheet& sheet = out[it->second];
    sheet.faces.push_back(f);
    for (const Index v : input.faces[f].loop) sheet.box.add(input.points[v]);
    sheet.coincidence = std::min(sheet.coincidence, input.faces[f].coincidence);
  }
  for (const auto& [ends, edge] : edges) {
    if (edge.isInside()) continue;
    for (const Index f : edge.forward) {
      out[sheet_of[together.find(local[f])]].edges.push_back({ends.first, ends.second});
    }
    for (const Index f : edge.backward) {
      out[sheet_of[together.find(local[f])]].edges.push_back({ends.second, ends.first});
    }
  }
}

}  // namespace

std::vector<Sheet> findSheets(const InputFaces& input, const std::vector<Plane>& planes) {
  std::vector<Sheet> out;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    std::map<std::pair<Index, int>, std::vector<Index>> alike;
    for (const Index f : planes[p].faces) {
      const int facing = glm::dot(input.faces[f].normal, planes[p].normal) > 0 ? 1 : -1;
      alike[{input.faces[f].surface, facing}].push_back(f);
    }
    for (const auto& [key, faces] : alike) {
      Sheet common;
      common.plane = Index(p);
      common.surface = key.first;
      common.facing = key.second;
      addSheets(input, faces, common, out);
    }
  }
  return out;
}

void EdgeTable::reserve(std::size_t count) {
  edges_.reserve(count);
  index_.reserve(count);
}

Index EdgeTable::find(Index a, Index b) const {
  const auto it = index_.find(edgeKey(a, b));
  return it == index_.end() ? kNone : it->second;
}

Index EdgeTable::obtain(Index a, Index b) {
  const auto [it, added] = index_.emplace(edgeKey(a, b), Index(edges_.size()));
  if (added) {
    edges_.emplace_back();
    edges_.back().a = std::min(a, b);
    edges_.back().b = std::max(a, b);
  }
  return it->second;
}

void EdgeTable::addUse(Index from, Index to, Index sheet, int count) {
  Edge& edge = edges_[obtain(from, to)];
  if (from > to) count = -count;
  const auto at =
      std::lower_bound(edge.uses.begin(), edge.uses.end(), sheet,
                       [](const EdgeUse& use, Index wanted) { return use.sheet < wanted; });
  if (at == edge.uses.end() || at->sheet != sheet) {
    edge.uses.insert(at, {sheet, count});
  } else {
    at->count += count;
    if (at->count == 0) edge.uses.erase(at);
  }
}

void EdgeTable::addContact(Index a, Index b, Index plane) {
  auto& contacts = edges_[obtain(a, b)].contacts;
  const auto at = std::lower_bound(contacts.begin(), contacts.end(), plane);
  if (at == contacts.end() || *at != plane) contacts.insert(at, plane);
}

std::vector<Index> EdgeTable::split(Index edge, const std::vector<Index>& between) {
  std::vector<Index> path{edges_[edge].a};
  path.insert(path.end(), between.begin(), between.end());
  path.push_back(edges_[edge].b);
  return replace(edge, path);
}

std::vector<Index> EdgeTable::merge(const std::vector<Index>& target) {
  std::vector<Index> out;
  const std::size_t count = edges_.size();
  for (Index e = 0; e < count; ++e) {
    const Index a = target[edges_[e].a];
    const Index b = target[edges_[e].b];
    if (!edges_[e].alive() || (a == edges_[e].a && b == edges_[e].b)) continue;
    const auto parts = replace(e, {a, b});
    out.insert(out.end(), parts.begin(), parts.end());
  }
  return out;
}

std::vector<Index> EdgeTable::replace(Index edge, const std::vector<Index>& path) {
  Edge old = std::exchange(edges_[edge], Edge{edges_[edge].a, edges_[edge].b, {}, {}});
  std::vector<Index> out;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    if (path[k] == path[k + 1]) continue;
    for (const EdgeUse& use : old.uses) addUse(path[k], path[k + 1], use.sheet, use.count);
    for (const Index plane : old.contacts) addContact(path[k], path[k + 1], plane);
    out.push_back(obtain(path[k], path[k + 1]));
  }
  replaced_.push_back(std::move(old));
  return out;
}

}  // namespace radiosity
