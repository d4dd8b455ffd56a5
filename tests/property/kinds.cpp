#include "kinds.h"

#include <algorithm>
#include <array>

#include "draw.h"

namespace radiosity::property {

namespace {

/// A rectangle or parallelogram, front along u x v.
Loop parallelogram(const Vec3& origin, const Vec3& u, const Vec3& v) {
  return {origin, origin + u, origin + u + v, origin + v};
}

Loop flipped(Loop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

/// A rectangle at height z facing up (or down).
Loop level(double x0, double y0, double x1, double y1, double z, bool up = true) {
  Loop loop{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return up ? loop : flipped(loop);
}

/// The faces of the box [-half, half], turned and moved.
std::vector<Loop> box(const Vec3& half, const glm::dmat3& turn, const Vec3& centre,
                      bool inward = false) {
  std::vector<Loop> faces;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 u(0.0), v(0.0), w(0.0);
    u[(axis + 1) % 3] = 2 * half[(axis + 1) % 3];
    v[(axis + 2) % 3] = 2 * half[(axis + 2) % 3];
    w[axis] = half[axis];
    for (const double side : {1.0, -1.0}) {
      Loop face = parallelogram(side * w - 0.5 * (u + v), u, v);
      if ((side < 0) != inward) face = flipped(face);
      for (Vec3& p : face) p = turn * p + centre;
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

const glm::dmat3 kUpright(1.0);

glm::dmat3 aboutVertical(Draw& draw) {
  return draw.turnAbout({0, 0, 1}, draw.uniform(0, 2 * std::numbers::pi));
}

Part part(Draw& draw, const std::string& name, double radiance = 0) {
  Part made;
  made.name = name;
  made.reflectance = draw.uniform(0.05, 0.9);
  made.radiance = radiance;
  return made;
}

/// Nothing leads out of the room.
void isClosed(Model& model) {
  model.known.closed = true;
  model.known.sky_area = 0;
}

/// Half the size of a room, about 2.
Vec3 addRoom(Model& model, Draw& draw) {
  const Vec3 half = draw.point(Vec3(0.5), Vec3(1.5));
  Part room = part(draw, "room");
  room.faces = box(half, kUpright, Vec3(0), true);
  model.parts.push_back(std::move(room));
  return half;
}

/// A lamp that hangs from the ceiling, lies in it, or is a box in the upper half.
void addLamp(Model& model, Draw& draw, const Vec3& half) {
  Part lamp = part(draw, "lamp", 5);
  const double x = draw.uniform(0.05, 0.4) * half.x;
  const double y = draw.uniform(0.05, 0.4) * half.y;
  const double way = draw.uniform(0, 1);
  if (way < 0.3) {
    lamp.faces = box({x, y, 0.05}, aboutVertical(draw), {0, 0, 0.6 * half.z});
  } else {
    const double z = way < 0.6 ? half.z : draw.uniform(0.8, 0.99) * half.z;
    lamp.faces = {level(-x, -y, x, y, z, false)};
  }
  model.parts.push_back(std::move(lamp));
}

/// A box that lies wholly within the lower part of the room.
std::vector<Loop> boxWithin(Draw& draw, const Vec3& half) {
  const double least = std::min({half.x, half.y, half.z});
  const Vec3 size = draw.point(Vec3(0.03), Vec3(0.2)) * least;
  const double radius = glm::length(size);
  const Vec3 low = -half + Vec3(1.01 * radius);
  const Vec3 high = Vec3(half.x, half.y, 0.3 * half.z) - Vec3(1.01 * radius);
  return box(size, draw.turn(), draw.point(low, glm::max(low, high)));
}

void addBoxes(Model& model, Draw& draw, const Vec3& half, int most) {
  const int count = draw.integer(1, most);
  for (int k = 0; k < count; ++k) {
    Part made = part(draw, "box" + std::to_string(k));
    made.faces = boxWithin(draw, half);
    model.parts.push_back(std::move(made));
  }
}

void furnishedRoom(Model& model, Draw& draw, int boxes) {
  const Vec3 half = addRoom(model, draw);
  addLamp(model, draw, half);
  addBoxes(model, draw, half, boxes);
}

void boxesInARoom(Model& model, Draw& draw) {
  furnishedRoom(model, draw, 4);
  isClosed(model);
}

/// Quadrilaterals become triangles, as most programs write them.
void triangulate(Model& model) {
  for (Part& part : model.parts) {
    std::vector<Loop> triangles;
    for (const Loop& face : part.faces) {
      for (std::size_t k = 2; k < face.size(); ++k) {
        triangles.push_back({face[0], face[k - 1], face[k]});
      }
    }
    part.faces = std::move(triangles);
  }
}

/// Moves coordinates of all corners of all faces by up to a share of the scene's size. As by
/// rounding, some stay as they are.
void shake(Model& model, Draw& draw, double share) {
  const double by = share * model.extent();
  const double moved = draw.chance(0.5) ? 1.0 : 0.6;
  for (Part& part : model.parts) {
    for (Loop& face : part.faces) {
      for (Vec3& p : face) {
        for (int axis = 0; axis < 3; ++axis) {
          if (draw.chance(moved)) p[axis] += by * draw.uniform(-1, 1);
        }
      }
    }
  }
}

/// A scene that another program has written with too few digits: corners of a room and of boxes in
/// it no longer meet.
void noise(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  if (draw.chance(0.5)) addLamp(model, draw, half);
  const int count = draw.integer(0, 2);
  const bool in_corner = draw.chance(0.2);
  for (int k = 0; k < count; ++k) {
    const Vec3 size = draw.point(Vec3(0.1), Vec3(0.3)) * half;
    Part made = part(draw, "box" + std::to_string(k));
    Vec3 at = draw.point(-0.3 * half, 0.3 * half);
    if (in_corner) at.x = size.x - half.x;
    if (draw.chance(0.7)) at.z = size.z - half.z;
    made.faces = box(size, in_corner || draw.chance(0.5) ? kUpright : aboutVertical(draw), at);
    model.parts.push_back(std::move(made));
  }
  if (draw.chance(0.7)) triangulate(model);
  // Half of them near the coincidence of 1e-7 of the diagonal.
  const double share = draw.chance(0.5) ? draw.powerOfTen(-9, -5) : draw.powerOfTen(-7.5, -6.5);
  shake(model, draw, share);
  model.known.at_weld_distance = share > 2e-8 && share < 3e-6;
  model.patches = std::size_t(draw.powerOfTen(1, 2.9));
}

/// Boxes that stand on the floor, against walls and on each other.
void touching(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  addLamp(model, draw, half);
  const double least = std::min({half.x, half.y, half.z});
  double z = -half.z;
  const int count = draw.integer(2, 4);
  const bool in_corner = draw.chance(0.5);
  for (int k = 0; k < count; ++k) {
    const Vec3 size = Vec3(0.2, 0.25, 0.1) * draw.uniform(0.6, 1.2) * least;
    Part made = part(draw, "box" + std::to_string(k));
    const Vec3 centre = in_corner
                            ? Vec3(size.x - half.x, size.y - half.y, z + size.z)
                            : Vec3(0.1 * k * least, draw.uniform(-0.1, 0.1) * least, z + size.z);
    made.faces = box(size, in_corner ? kUpright : aboutVertical(draw), centre);
    model.parts.push_back(std::move(made));
    z += 2 * size.z;
    // Back to the floor, beside or into the others.
    if (z + 0.3 * least > half.z || draw.chance(0.4)) z = -half.z;
  }
  model.patches = std::size_t(draw.integer(2, 40));
  isClosed(model);
}

/// Triangles and strips thinner than anything in the room.
void slivers(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  addLamp(model, draw, half);
  Part thin = part(draw, "sliver");
  thin.two_sided = draw.chance(0.5);
  const int count = draw.integer(1, 6);
  for (int k = 0; k < count; ++k) {
    const Vec3 along = 0.3 * draw.direction();
    const Vec3 across =
        draw.powerOfTen(-5, -1) * glm::normalize(glm::cross(along, draw.direction()));
    const Vec3 middle = draw.point(-0.1 * half, 0.1 * half);
    if (draw.chance(0.5)) {
      thin.faces.push_back({middle - along, middle + along, middle + across});
    } else {
      thin.faces.push_back(parallelogram(middle - along, 2.0 * along, across));
    }
  }
  model.parts.push_back(std::move(thin));
  model.finest = 3e-6;
  isClosed(model);
}

/// Rugs, panels and lamps that lie in the floor and the walls, over each other.
void coplanar(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  const int count = draw.integer(2, 5);
  for (int k = 0; k < count; ++k) {
    Part made = part(draw, "panel" + std::to_string(k), k == 0 ? 5 : 0);
    const Vec3 size = draw.point(Vec3(0.1), Vec3(0.4)) * half;
    const Vec3 at = draw.point(-0.5 * half, 0.5 * half);
    Loop face = level(at.x - size.x, at.y - size.y, at.x + size.x, at.y + size.y, -half.z);
    if (draw.chance(0.5)) {
      const glm::dmat3 turn = draw.turnAbout({0, 0, 1}, draw.uniform(0, 1));
      for (Vec3& p : face) p = turn * (p * Vec3(0.5, 0.5, 1));
    }
    made.faces.push_back(std::move(face));
    model.parts.push_back(std::move(made));
  }
  isClosed(model);
}

/// Boxes that run through each other and sheets that cut them.
void crossing(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  addLamp(model, draw, half);
  const double least = std::min({half.x, half.y, half.z});
  const int count = draw.integer(2, 3);
  for (int k = 0; k < count; ++k) {
    Part made = part(draw, "box" + std::to_string(k));
    const Vec3 size = draw.point(Vec3(0.08), Vec3(0.3)) * least;
    made.faces = box(size, draw.turn(), draw.point(Vec3(-0.1), Vec3(0.1)) * least);
    model.parts.push_back(std::move(made));
  }
  if (draw.chance(0.5)) {
    Part sheet = part(draw, "sheet");
    sheet.two_sided = draw.chance(0.5);
    const Vec3 u = 0.5 * least * draw.direction();
    const Vec3 v = 0.5 * least * glm::normalize(glm::cross(u, draw.direction()));
    sheet.faces.push_back(parallelogram(-0.5 * (u + v), u, v));
    model.parts.push_back(std::move(sheet));
  }
  model.patches = std::size_t(draw.integer(2, 40));  // cuts make more
  isClosed(model);
}

/// A lamp that goes through a wall: a box or a plate.
void lampThroughTheWall(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  Part lamp = part(draw, "lamp", 5);
  const Vec3 centre(half.x, draw.uniform(-0.2, 0.2), draw.uniform(-0.2, 0.2));
  const Vec3 size(draw.uniform(0.1, 0.4), draw.uniform(0.02, 0.2), draw.uniform(0.02, 0.2));
  if (draw.chance(0.5)) {
    lamp.faces = box(size, draw.chance(0.5) ? kUpright : aboutVertical(draw), centre);
  } else {
    const Vec3 u(2 * size.x, 0, 0);
    const Vec3 v(0, 2 * size.y, draw.chance(0.5) ? 0 : size.z);
    lamp.faces.push_back(parallelogram(centre - 0.5 * (u + v), u, v));
    lamp.two_sided = draw.chance(0.3);
  }
  model.parts.push_back(std::move(lamp));
  if (draw.chance(0.5)) addBoxes(model, draw, half, 2);
  model.known.closed = false;
}

/// A room whose ceiling stops short of a wall.
void slit(Model& model, Draw& draw) {
  const Vec3 half = addRoom(model, draw);
  std::vector<Loop>& faces = model.parts[0].faces;
  const double gap = draw.powerOfTen(-4, -2) * 2 * half.x;
  faces[4] = level(-half.x, -half.y, half.x - gap, half.y, half.z, false);  // was the ceiling
  if (draw.chance(0.5)) {
    addBoxes(model, draw, half, 2);
  } else {
    // Under the slit: nothing looks out past it but at a slant.
    Part shelf = part(draw, "shelf");
    shelf.two_sided = true;
    const double z = half.z - draw.uniform(0.1, 0.4);
    shelf.faces = {level(0.2, -0.9 * half.y, half.x, 0.9 * half.y, z)};
    model.parts.push_back(std::move(shelf));
  }
  Part lamp = part(draw, "lamp", 5);
  lamp.faces = box(Vec3(0.1), draw.turn(), {0, 0, 0.3 * half.z});
  model.parts.push_back(std::move(lamp));
  model.known.closed = false;
  model.known.sky_area = gap * 2 * half.y;
}

/// F between facing rectangles a x b at the distance c (Howell C-11), and what it lacks to 1.
double facing(double a, double b, double c) {
  using Long = long double;
  const Long x = Long(a) / c, y = Long(b) / c;
  const Long p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  const Long sum = 0.5L * std::log(p * p * q * q / (1 + x * x + y * y)) + x * q * std::atan(x / q) +
                   y * p * std::atan(y / p) - x * std::atan(x) - y * std::atan(y);
  return double(2 / (std::numbers::pi_v<Long> * x * y) * sum);
}

/// Two plates with a gap from a hundred millionth of their size on.
void facingPlates(Model& model, Draw& draw) {
  const double a = draw.uniform(0.3, 2);
  const double b = draw.uniform(0.3, 2);
  const double gap = draw.powerOfTen(-8, 0);
  Part low = part(draw, "a", 1);
  Part high = part(draw, "b");
  low.faces = {level(0, 0, a, b, 0)};
  high.faces = {level(0, 0, a, b, gap, false)};
  model.parts = {low, high};
  model.known.closed = false;
  const double f = facing(a, b, gap);
  // At small gaps rounding in the formula is that of its largest term over the gap.
  model.known.factor = {"a", "b", f, 1e-15};
  model.known.sky_area = 2 * a * b * (1 - f);
  model.finest = gap / 2;
  // 1e-7 of the diagonal, and some room for a rule of several points.
  model.known.at_weld_distance = gap < 3e-7 * std::sqrt(a * a + b * b);
  model.patches = std::size_t(draw.integer(2, 60));
}

/// F from a small square to a rectangle above it, at its middle (Howell B-3, four quarters).
double overhead(double a, double b, double c) {
  const double x = 0.5 * a / c, y = 0.5 * b / c;
  const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return 2 / std::numbers::pi * (x / p * std::atan(y / p) + y / q * std::atan(x / q));
}

/// A small thing before a large one far away: a craft over a planet, a sensor in a hall.
void smallBeforeLarge(Model& model, Draw& draw) {
  const double small = draw.powerOfTen(-9, -2);
  const double a = draw.uniform(0.5, 2), b = draw.uniform(0.5, 2), c = draw.powerOfTen(-1.3, 0.5);
  Part craft = part(draw, "craft");
  Part planet = part(draw, "planet", 1);
  craft.faces = {level(-0.5 * small, -0.5 * small, 0.5 * small, 0.5 * small, 0)};
  planet.faces = {level(-0.5 * a, -0.5 * b, 0.5 * a, 0.5 * b, c, false)};
  model.parts = {craft, planet};
  model.known.closed = false;
  // The mean over the square is that at its middle but for a second-order term.
  model.known.factor = {"craft", "planet", overhead(a, b, c), 4 * small * small / (c * c)};
  model.finest = small / 2;
  model.patches = std::size_t(draw.integer(2, 80));
}

/// Plates that hardly see each other.
void faint(Model& model, Draw& draw) {
  Part from = part(draw, "a", 1);
  Part to = part(draw, "b");
  const double size = draw.powerOfTen(-3, 0);
  const double other = draw.powerOfTen(-3, 0);
  from.faces = {level(3, 0, 3 + size, size, 0)};
  // Upright at x = 0, just above the plane of the first, facing it.
  to.faces = {parallelogram({0, 0, draw.uniform(0, 0.2)}, {0, other, 0}, {0, 0, 0.3 * other})};
  model.parts = {from, to};
  model.known.closed = false;
  model.patches = std::size_t(draw.integer(2, 60));
}

void column(std::vector<Loop>& faces, const Vec2& at, double radius, double z1, int sides,
            double angle) {
  std::vector<Vec2> base;
  for (int k = 0; k < sides; ++k) {
    const double a = angle + 2 * std::numbers::pi * k / sides;
    base.emplace_back(at.x + radius * std::cos(a), at.y + radius * std::sin(a));
  }
  Loop top;
  for (int k = 0; k < sides; ++k) {
    const Vec2& p = base[std::size_t(k)];
    const Vec2& q = base[std::size_t((k + 1) % sides)];
    faces.push_back({{p.x, p.y, 0}, {q.x, q.y, 0}, {q.x, q.y, z1}, {p.x, p.y, z1}});
    top.emplace_back(p.x, p.y, z1);
  }
  faces.push_back(std::move(top));
}

/// Rows of columns on a floor, before a wall or under a roof that they carry.
void colonnade(Model& model, Draw& draw) {
  const int count = draw.integer(2, 6);
  const int rows = draw.integer(1, 2);
  const double wide = draw.uniform(1, 3);
  const double high = draw.uniform(0.5, 1.5);
  Part floor = part(draw, "floor");
  floor.faces = {level(-0.3, -1, wide + 0.3, 1, 0)};
  Part wall = part(draw, "wall", 1);
  if (draw.chance(0.5)) {
    wall.faces = {level(-0.3, -1, wide + 0.3, 1, high, false)};
  } else {
    wall.faces = {parallelogram({-0.3, 1, 0}, {wide + 0.6, 0, 0}, {0, 0, high})};
  }
  Part columns = part(draw, "columns");
  const int sides = draw.integer(3, 24);
  const double radius = draw.uniform(0.05, 0.25) * wide / count;
  const double angle = draw.uniform(0, 1);
  for (int k = 0; k < count * rows; ++k) {
    const double x = wide * (k % count + 0.5) / count;
    const double y = k < count ? draw.uniform(-0.02, 0.02) : 0.5;
    column(columns.faces, {x, y}, radius, draw.chance(0.7) ? high : 0.9 * high, sides, angle);
  }
  model.parts = {floor, wall, columns};
  model.known.closed = false;
  model.patches = std::size_t(draw.integer(60, 300));
}

/// Slats between a floor and a wall.
void blinds(Model& model, Draw& draw) {
  const int count = draw.integer(4, 16);
  Part floor = part(draw, "floor");
  floor.faces = {level(0, 0, 3, 2, 0)};
  Part out = part(draw, "out", 1);
  out.faces = {parallelogram({-1, 0, 0}, {0, 2, 0}, {0, 0, 2})};
  Part slats = part(draw, "slats");
  slats.two_sided = draw.chance(0.7);
  const double pitch = 1.9 / count;
  const double angle = draw.uniform(-1.4, 1.4);
  const double width = draw.uniform(0.3, 1.2) * pitch;
  for (int k = 0; k < count; ++k) {
    slats.faces.push_back(parallelogram({-0.02, 0.1, 0.05 + pitch * k}, {0, 1.8, 0},
                                        {width * std::cos(angle), 0, width * std::sin(angle)}));
  }
  model.parts = {floor, out, slats};
  model.known.closed = false;
  model.patches = std::size_t(draw.integer(60, 250));
}

/// Open ground under a sky.
void terrain(Model& model, Draw& draw) {
  const int n = draw.integer(3, 7);
  Part ground = part(draw, "ground", draw.chance(0.3) ? 1 : 0);
  std::vector<Vec3> at;
  const double rough = draw.powerOfTen(-3, 0);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) at.emplace_back(i, j, rough * draw.uniform(0, 1));
  }
  const auto point = [&](int i, int j) {
    return at[std::size_t(i) * std::size_t(n + 1) + std::size_t(j)];
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      ground.faces.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
      ground.faces.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  model.parts = {ground};
  model.sky = 1;
  model.known.closed = false;
  model.patches = std::size_t(draw.integer(20, 150));
}

/// Sheets in any place, through each other, seen from both sides.
void sheets(Model& model, Draw& draw) {
  const int count = draw.integer(2, 7);
  for (int k = 0; k < count; ++k) {
    Part sheet = part(draw, "sheet" + std::to_string(k), k == 0 ? 1 : 0);
    sheet.two_sided = draw.chance(0.7);
    const Vec3 u = draw.uniform(0.2, 1.5) * draw.direction();
    const Vec3 v = draw.uniform(0.2, 1.5) * glm::normalize(glm::cross(u, draw.direction()));
    sheet.faces.push_back(parallelogram(draw.point(Vec3(-0.5), Vec3(0.5)) - 0.5 * (u + v), u, v));
    model.parts.push_back(std::move(sheet));
  }
  model.known.closed = false;
}

/// A room as CAD programs export it: its normals point away from the light within.
void outwardRoom(Model& model, Draw& draw) {
  const Vec3 half = draw.point(Vec3(0.5), Vec3(1.5));
  std::vector<Loop> faces = box(half, kUpright, Vec3(0));
  if (draw.chance(0.5)) {
    Part room = part(draw, "room", 1);
    room.faces = std::move(faces);
    model.parts.push_back(std::move(room));
  } else {
    const std::array<const char*, 3> names{"sides", "ends", "levels"};
    for (std::size_t k = 0; k < names.size(); ++k) {
      Part walls = part(draw, names[k], k == 0 ? 1 : 0);
      walls.faces = {faces[2 * k], faces[2 * k + 1]};
      model.parts.push_back(std::move(walls));
    }
  }
  model.known.closed = false;
  model.known.inside_out = true;
}

constexpr std::array kKinds{
    Kind{"room", boxesInARoom},       Kind{"noise", noise},       Kind{"touching", touching},
    Kind{"slivers", slivers},         Kind{"coplanar", coplanar}, Kind{"crossing", crossing},
    Kind{"poke", lampThroughTheWall}, Kind{"slit", slit},         Kind{"plates", facingPlates},
    Kind{"small", smallBeforeLarge},  Kind{"faint", faint},       Kind{"colonnade", colonnade},
    Kind{"blinds", blinds},           Kind{"terrain", terrain},   Kind{"sheets", sheets},
    Kind{"outward", outwardRoom},
};

/// Turns, scales and moves the scene, each half the time.
void place(Model& model, Draw& draw) {
  const glm::dmat3 turn = draw.chance(0.5) ? draw.turn() : kUpright;
  const double scale = draw.chance(0.5) ? draw.powerOfTen(-6, 6) : 1.0;
  // Rounding of the corners stays below a millionth of the finest length.
  const double farthest = std::clamp(std::log10(model.finest) + 10, 0.0, 6.0);
  const double away = draw.chance(0.5) ? draw.powerOfTen(0, farthest) : 0.0;
  const Vec3 by = scale * away * model.extent() * draw.direction();
  for (Part& part : model.parts) {
    for (Loop& face : part.faces) {
      for (Vec3& p : face) p = scale * (turn * p) + by;
    }
  }
  if (model.known.sky_area) *model.known.sky_area *= scale * scale;
  if (model.known.factor) model.known.factor->error += 1e-15 * away / model.finest;
}

}  // namespace

std::span<const Kind> kinds() { return kKinds; }

Model makeModel(const Kind& kind, std::uint64_t seed) {
  std::uint64_t mixed = seed;
  for (const char* c = kind.name; *c != 0; ++c)
    mixed = mixed * 0x9e3779b97f4a7c15u + std::uint64_t(*c);
  Draw draw(mixed);
  Model model;
  model.kind = kind.name;
  model.seed = seed;
  model.patches = std::size_t(draw.integer(10, 80));
  model.exact_emitters = draw.chance(0.5);
  kind.fill(model, draw);
  place(model, draw);
  return model;
}

}  // namespace radiosity::property
