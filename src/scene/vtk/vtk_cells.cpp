#include "scene/vtk/vtk_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

namespace radiosity {

namespace {

constexpr long long kPixel = 8;
constexpr long long kVoxel = 11;
constexpr long long kQuadraticPolygon = 36;

/// The number of corners of a volume; 0 for prisms of five and six sides and polyhedra. Empty if
/// the type is not a volume.
std::optional<int> cornersOfVolume(long long type) {
  switch (type) {
    case 10:
    case 24:
    case 71:
    case 78:
      return 4;
    case 14:
    case 27:
    case 37:
    case 74:
    case 81:
      return 5;
    case 13:
    case 26:
    case 31:
    case 32:
    case 73:
    case 80:
      return 6;
    case kVoxel:
    case 12:
    case 25:
    case 29:
    case 33:
    case 72:
    case 79:
      return 8;
    case 15:
    case 16:
    case 41:
    case 42:
      return 0;
    default:
      return std::nullopt;
  }
}

/// The shape of a cell with `nodes` points. Empty for a type that VTK does not have.
std::optional<ElementShape> vtkShape(long long type, std::size_t nodes) {
  const int n = int(std::min<std::size_t>(nodes, 1000));
  switch (type) {
    case 0:  // empty
    case 1:
    case kVtkPolyVertex:
      return ElementShape{0, 0, n};
    case 3:
    case kVtkPolyLine:
    case 21:
    case 35:
    case 68:
    case 75:
      return ElementShape{1, 2, n};
    case 5:
    case 22:
    case 34:
    case 69:
    case 76:
      return ElementShape{2, 3, n};
    case 9:
    case kPixel:
    case 23:
    case 28:
    case 30:
    case 70:
    case 77:
      return ElementShape{2, 4, n};
    case kVtkPolygon:
    case kVtkStrip:
      return ElementShape{2, 3, 0};
    case kQuadraticPolygon:
      return ElementShape{2, n / 2, n};
    default:
      break;
  }
  if (const std::optional<int> corners = cornersOfVolume(type)) {
    return ElementShape{3, *corners, n};
  }
  return std::nullopt;
}

class CellAdder {
 public:
  CellAdder(const VtkCells& cells, const std::string& file, const std::string& name,
            std::size_t first, GroupedFaces& faces)
      : cells_(cells), file_(file), name_(name), first_(first), faces_(faces) {}

  void run() {
    const std::size_t count = cells_.ends.size();
    if (cells_.types.size() != count) {
      throw InputError(fmt::format("{}: {} cells have {} types; export it again", file_, count,
                                   cells_.types.size()));
    }
    long long begin = 0;
    for (cell_ = 0; cell_ < count; ++cell_) {
      const long long end = cells_.ends[cell_];
      if (end < begin || end > static_cast<long long>(cells_.connectivity.size())) {
        fail("its points end before they begin, or beyond the last; export the file again");
      }
      take(std::span(cells_.connectivity).subspan(std::size_t(begin), std::size_t(end - begin)));
      add(cells_.types[cell_]);
      begin = end;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: cell {}: {}", file_, first_ + cell_, what));
  }

  void take(std::span<const long long> numbers) {
    corners_.clear();
    for (const long long number : numbers) {
      if (number < 0 || std::size_t(number) >= cells_.points.size()) {
        fail(fmt::format("point {} does not exist, there are {} (from 0); correct it", number,
                         cells_.points.size()));
      }
      corners_.push_back(cells_.points[std::size_t(number)]);
    }
  }

  void add(long long type) {
    const std::optional<ElementShape> shape = vtkShape(type, corners_.size());
    if (!shape) fail(fmt::format("cells of type {} are not read; export polygons", type));
    const int least = shape->dimension == 2 ? std::max(shape->corners, 3) : shape->corners;
    if (shape->dimension >= 2 && std::size_t(least) > corners_.size()) {
      fail(fmt::format("a {} of {} points has too few; correct or remove it",
                       shape->dimension == 2 ? "face" : "volume", corners_.size()));
    }
    // The corners are row by row, not in a loop.
    if (type == kPixel || type == kVoxel) std::swap(corners_[2], corners_[3]);
    if (type == kVoxel) std::swap(corners_[6], corners_[7]);
    if (type == kVtkStrip) return addStrip();
    faces_.addElement(*shape, corners_, group(), first_ + cell_);
  }

  /// Adds a strip: triangle k has points k, k + 1, k + 2; every second one is turned over.
  void addStrip() {
    for (std::size_t k = 0; k + 2 < corners_.size(); ++k) {
      const std::size_t odd = k % 2;
      const Index triangle[] = {corners_[k], corners_[k + 1 + odd], corners_[k + 2 - odd]};
      faces_.addFace(triangle, group(), first_ + cell_);
    }
  }

  const std::string& group() const {
    return cell_ < cells_.groups.size() ? cells_.groups[cell_] : name_;
  }

  const VtkCells& cells_;
  const std::string& file_;
  const std::string& name_;
  std::size_t first_;
  GroupedFaces& faces_;
  std::size_t cell_ = 0;
  std::vector<Index> corners_;
};

}  // namespace

VtkGroupRank vtkGroupRank(std::string_view array, bool has_words, bool differs_everywhere) {
  return {has_words ? 0 : differs_everywhere ? 2 : 1, groupArrayRank(array).value_or(kNone)};
}

bool allDiffer(std::span<const long long> values) {
  std::vector<long long> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

std::string vtkGroupName(const std::string& array, long long value) {
  return fmt::format("{} {}", array, value);
}

void addVtkCells(const VtkCells& cells, const std::string& file, const std::string& name,
                 std::size_t first, GroupedFaces& faces) {
  CellAdder(cells, file, name, first, faces).run();
}

}  // namespace radiosity
