#include "heat/heat_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "heat/conditions.h"
#include "scene/text.h"
#include "solve/singular.h"

namespace radiosity {

namespace {

/// The tolerance of the linear system, as a share of the tolerance asked for.
constexpr double kLinearShare = 0.01;
constexpr double kRounding = 1e-14;
/// If the equations are not linear in x = sigma T^4, a step keeps at least this share of x, so that
/// T falls to a quarter at most.
constexpr double kLargestFall = 1.0 / 256;
/// Where emissivity rises with temperature faster than emission, more heat is absorbed in a hotter
/// node. There, and where less than this share of the slope is left, a step takes the emissivity as
/// constant.
constexpr double kLeastSlope = 0.1;

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

bool canEmit(const Emissivity& emissivity) {
  return std::any_of(emissivity.values.begin(), emissivity.values.end(),
                     [](double value) { return value > 0; });
}

bool allFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

bool hasTable(const HeatCondition& condition) {
  return std::any_of(condition.emissivity.begin(), condition.emissivity.end(),
                     [](const Emissivity& e) { return !e.temperatures.empty(); });
}

/// Its matrix.
const ExchangeOperator& checked(const FormFactors& factors) {
  if (!factors.matrix) throw InputError("heat: the form factors came without their matrix");
  const std::size_t n = factors.matrix->size();
  if (factors.fronts.size() != n || factors.backs.size() != n || factors.sky.size() != n) {
    throw InputError(
        fmt::format("heat: a matrix of {} rows needs accounts of as many (fronts, backs, sky)", n));
  }
  return *factors.matrix;
}

}  // namespace

HeatSolve::HeatSolve(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                     Progress& progress)
    : factors_(factors),
      rows_(rows),
      options_(options),
      progress_(progress),
      black_(options),
      n_(checked(factors).size()),
      width_(std::size_t(options.bands.count())),
      area_(factors.matrix->area()) {
  validate(rows.conditions, options.bands.count());
  nodes_ = heatNodes(rows, area_);
  temperature_.resize(n_);
  emissivity_.resize(n_ * width_);
  emitted_.resize(n_ * width_);
  falling_.resize(n_ * width_);
  requireEmitters();
  start();
  findDark();
  const double sky = black_.total(options.sky_temperature);
  for (std::size_t k = 0; k < falling_.size(); ++k) {
    falling_[k] = std::max(0.0, factors.sky[k / width_]) * sky *
                  black_.fraction(int(k % width_), options.sky_temperature);
  }
}

/// Refuses heat that is supplied to a node without emission and convection: it has no way out.
void HeatSolve::requireEmitters() const {
  for (const HeatNode& node : nodes_.nodes) {
    const HeatCondition& c = rows_.conditions[node.condition];
    if (node.supplied == 0 || c.convection > 0) continue;
    if (std::none_of(c.emissivity.begin(), c.emissivity.end(), canEmit)) {
      throw InputError(fmt::format(
          "{}: has emissivity 0 and no convection, so the heat supplied to it ({:g} W/m^2) cannot "
          "leave; give it an emissivity above 0",
          c.name, node.supplied / node.area));
    }
  }
}

bool HeatSolve::isLinear() const {
  if (!black_.linear()) return false;
  return std::none_of(rows_.conditions.begin(), rows_.conditions.end(),
                      [](const auto& c) { return isFree(c) && (c.convection > 0 || hasTable(c)); });
}

/// Sets the row's temperature, and its emissivity and emission there.
void HeatSolve::placeAt(double temperature, std::size_t row) {
  temperature_[row] = temperature;
  const double total = black_.total(temperature);
  for (std::size_t b = 0; b < width_; ++b) {
    const double emissivity = emissivityIn(conditionOf(row), b).at(temperature);
    emissivity_[row * width_ + b] = emissivity;
    emitted_[row * width_ + b] = emissivity * total * black_.fraction(int(b), temperature);
  }
}

void HeatSolve::place() {
  for (std::size_t n = 0; n < nodes_.nodes.size(); ++n) {
    const double temperature = black_.temperatureOf(x_[n]);
    for (const Index i : nodes_.nodes[n].rows) placeAt(temperature, i);
  }
}

/// Starts from 0 K if one step is exact. Otherwise x starts from the mean of the given
/// temperatures, or from the largest flux supplied if that is more.
void HeatSolve::start() {
  double sum = 0;
  double weight = 0;
  const auto count = [&](double area, double temperature) {
    sum += area * black_.total(temperature);
    weight += area;
  };
  for (std::size_t i = 0; i < n_; ++i) {
    const HeatCondition& c = conditionOf(i);
    if (c.temperature) {
      placeAt(*c.temperature, i);
      count(area_[i], *c.temperature);
    } else if (c.convection > 0) {
      count(area_[i], c.ambient);
    }
    if (looksOut(factors_, i))
      count(area_[i] * std::max(0.0, factors_.sky[i]), options_.sky_temperature);
  }
  double from = weight > 0 ? sum / weight : 0;
  for (const HeatNode& node : nodes_.nodes) {
    if (node.area > 0) from = std::max(from, node.supplied / node.area);
  }
  cold_ = !(from > 0) && std::ranges::none_of(
                             nodes_.nodes, [](const HeatNode& node) { return node.supplied != 0; });
  if (!(from > 0)) from = 1;  // any positive value will do
  x_.assign(nodes_.nodes.size(), isLinear() ? 0 : from);
  last_step_.assign(x_.size(), 0.0);
  longest_step_.assign(x_.size(), std::numeric_limits<double>::infinity());
  place();
}

std::string HeatSolve::namesOf(const std::vector<double>& marks) const {
  std::vector<std::string> names;
  std::set<Index> seen;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const Index condition = rows_.of_row[k / width_];
    if (marks[k] != 0 && seen.insert(condition).second) {
      names.push_back(rows_.conditions[condition].name);
    }
  }
  return joinNames(names, 20);
}

/// Marks every row and band whose light reaches something that fixes its level: a given
/// temperature, convection, the sky or a back. An emitter that is not marked has no solution. Other
/// rows that are not marked stay dark.
void HeatSolve::findDark() {
  std::vector<double> marks(n_ * width_, 0.0);
  const auto emits = [&](std::size_t k) {
    return canEmit(emissivityIn(conditionOf(k / width_), k % width_));
  };
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const HeatCondition& c = conditionOf(k / width_);
    const bool fixed = c.temperature ? emissivity_[k] > 0 : c.convection > 0 && emits(k);
    const bool has_area = area_[k / width_] > 0;
    marks[k] = double(has_area && (fixed || looksOut(factors_, k / width_)));
  }
  for (bool changed = true; changed;) {
    if (std::all_of(marks.begin(), marks.end(), [](double mark) { return mark != 0; })) break;
    markAllThatSee(*factors_.matrix, int(width_), marks);
    changed = false;
    for (const HeatNode& node : nodes_.nodes) changed = markNode(node, marks) || changed;
    progress_.check();
  }
  dark_.assign(marks.size(), 0);
  std::vector<double> lost(marks.size(), 0.0);
  double supplied = 0;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    dark_[k] = marks[k] == 0;
    const Index node = nodes_.of_row[k / width_];
    const bool stuck = dark_[k] && area_[k / width_] > 0 && node != kNone && emits(k);
    if (!stuck) continue;
    lost[k] = 1;
    if (nodes_.nodes[node].rows.front() == k / width_) supplied += nodes_.nodes[node].supplied;
  }
  if (largest(lost) > 0) refuseClosed(lost, supplied);
}

void HeatSolve::refuseClosed(const std::vector<double>& lost, double supplied) const {
  throw InputError(fmt::format(
      "the temperatures of {} have no level: heat supplied there, {:g} W in all, can only go round "
      "in a closed room in which nothing has a temperature of its own; give one of them a "
      "temperature or convection",
      namesOf(lost), supplied));
}

/// If one of the emitting rows and bands of a node is marked, marks the others. True if any is new.
bool HeatSolve::markNode(const HeatNode& node, std::vector<double>& marks) const {
  std::vector<std::size_t> emitting;
  for (const Index i : node.rows) {
    for (std::size_t b = 0; b < width_; ++b) {
      if (area_[i] > 0 && canEmit(emissivityIn(conditionOf(i), b)))
        emitting.push_back(i * width_ + b);
    }
  }
  const auto marked = [&](std::size_t k) { return marks[k] != 0; };
  if (std::none_of(emitting.begin(), emitting.end(), marked)) return false;
  if (std::all_of(emitting.begin(), emitting.end(), marked)) return false;
  for (const std::size_t k : emitting) marks[k] = 1;
  return true;
}

/// The heat, W, that the node gains at its temperature without irradiance.
double HeatSolve::heatWithoutLight(std::size_t n) const {
  const HeatNode& node = nodes_.nodes[n];
  const HeatCondition& c = rows_.conditions[node.condition];
  double heat = node.supplied;
  if (c.convection > 0) {
    heat += c.convection * node.area * (c.ambient - temperature_[node.rows.front()]);
  }
  for (const Index i : node.rows) {
    for (std::size_t b = 0; b < width_; ++b) heat -= area_[i] * emitted_[i * width_ + b];
  }
  return heat;
}

HeatSystem HeatSolve::system(const std::vector<double>& irradiance) {
  HeatSystem s;
  s.bands = int(width_);
  s.source = emitted_;
  s.falling = falling_;
  s.node = nodes_.of_row;
  s.nodes = nodes_.nodes.size();
  s.emits.assign(n_ * width_, 0.0);
  s.absorbs.resize(n_ * width_);
  s.reflected.resize(n_ * width_);
  for (std::size_t k = 0; k < s.absorbs.size(); ++k) {
    s.absorbs[k] = area_[k / width_] * emissivity_[k];
    s.reflected[k] = dark_[k] ? 0 : 1 - emissivity_[k];
  }
  gain_.assign(s.nodes, 0.0);
  lack_.assign(s.nodes, 0.0);
  for (std::size_t n = 0; n < s.nodes; ++n) linearize(n, irradiance, s);
  return s;
}

/// The derivatives of J by x for each row and band of the node, irradiance unchanged.
std::vector<double> HeatSolve::emissionSlopes(std::size_t n,
                                              const std::vector<double>& irradiance) const {
  const HeatNode& node = nodes_.nodes[n];
  const HeatCondition& condition = rows_.conditions[node.condition];
  const double temperature = temperature_[node.rows.front()];
  std::vector<double> constant;
  std::vector<double> slopes;
  double left = 0;
  for (const Index i : node.rows) {
    for (std::size_t b = 0; b < width_; ++b) {
      const std::size_t k = i * width_ + b;
      constant.push_back(emissivity_[k] * black_.slope(int(b), temperature));
      slopes.push_back(constant.back());
      const double rise = slopeOf(emissivityIn(condition, b), temperature);
      if (rise != 0 && !irradiance.empty()) {
        const double black = black_.total(temperature) * black_.fraction(int(b), temperature);
        slopes.back() += rise * temperature / (4 * x_[n]) * (black - irradiance[k]);
      }
      left += area_[i] * (slopes.back() - kLeastSlope * constant.back());
    }
  }
  return left > 0 ? slopes : constant;
}

/// Linearises the node's part of the system around its temperature.
void HeatSolve::linearize(std::size_t n, const std::vector<double>& irradiance, HeatSystem& s) {
  const HeatNode& node = nodes_.nodes[n];
  const double convection = rows_.conditions[node.condition].convection;
  const double temperature = temperature_[node.rows.front()];
  const std::vector<double> slopes = emissionSlopes(n, irradiance);
  std::size_t part = 0;
  for (const Index i : node.rows) {
    for (std::size_t b = 0; b < width_; ++b) gain_[n] += area_[i] * slopes[part++];
  }
  if (convection > 0) gain_[n] += convection * node.area * temperature / (4 * x_[n]);
  if (!(gain_[n] > 0)) return;
  lack_[n] = heatWithoutLight(n);
  part = 0;
  for (const Index i : node.rows) {
    for (std::size_t b = 0; b < width_; ++b) {
      const std::size_t k = i * width_ + b;
      s.emits[k] = slopes[part++] / gain_[n];
      s.source[k] += s.emits[k] * lack_[n];
    }
  }
}

/// The step of a node in x. One that turns back at a corner of its table is at most half as long as
/// the step before, and so are all that follow.
double HeatSolve::limited(std::size_t n, double step) {
  if (!hasTable(rows_.conditions[nodes_.nodes[n].condition])) return step;
  if (step * last_step_[n] < 0) {
    longest_step_[n] = std::min(longest_step_[n], std::abs(last_step_[n]) / 2);
  }
  last_step_[n] = std::clamp(step, -longest_step_[n], longest_step_[n]);
  return last_step_[n];
}

/// Computes temperatures from the irradiance of their nodes. Errors: InputError if more heat is
/// taken out of a node than it can take up.
void HeatSolve::step(const HeatSystem& s, HeatFields& fields) {
  if (cold_) {
    std::ranges::fill(x_, 0.0);
    std::ranges::fill(fields.radiosity, 0.0);
    return place();
  }
  const double scale = largest(fields.radiosity);
  const bool linear = isLinear();
  for (std::size_t n = 0; n < x_.size(); ++n) {
    if (!(gain_[n] > 0)) continue;
    double heat = lack_[n];
    for (const Index i : nodes_.nodes[n].rows) {
      for (std::size_t b = 0; b < width_; ++b) {
        heat += s.absorbs[i * width_ + b] * fields.irradiance[i * width_ + b];
      }
    }
    const double next = x_[n] + limited(n, heat / gain_[n]);
    const double floor = linear ? 0 : x_[n] * kLargestFall;
    const double off = linear ? -next : floor - next;
    const double nothing = linear ? options_.tolerance * scale : 0;
    const bool frozen = linear || x_[n] < std::min(1e-12, 1e-3 * options_.tolerance) * scale;
    if (frozen && off > nothing) refuseCold(n);
    x_[n] = std::max(next, floor);
  }
  place();
}

/// The node at 0 K is n. The heat may be taken out elsewhere: the node that gives most is named.
void HeatSolve::refuseCold(std::size_t n) const {
  const auto fluxOf = [](const HeatNode& node) {
    return node.area > 0 ? node.supplied / node.area : 0.0;
  };
  const HeatNode& most = *std::ranges::min_element(nodes_.nodes, {}, fluxOf);
  const HeatNode& node = fluxOf(most) < 0 ? most : nodes_.nodes[n];
  throw InputError(fmt::format(
      "{}: more heat is taken out of it ({:g} W/m^2) than it could take up at 0 K, so it has no "
      "temperature; take out less",
      rows_.conditions[node.condition].name, -fluxOf(node)));
}

/// The true residuals: H is multiplied anew. Values that are not finite give infinity.
HeatSolve::Residuals HeatSolve::residuals(HeatFields& fields) const {
  factors_.matrix->product(fields.radiosity, int(width_), fields.irradiance);
  for (std::size_t k = 0; k < falling_.size(); ++k) fields.irradiance[k] += falling_[k];
  Residuals worst;
  if (!allFinite(fields.radiosity) || !allFinite(fields.irradiance) || !allFinite(temperature_)) {
    worst.radiosity = worst.balance = std::numeric_limits<double>::infinity();
    return worst;
  }
  const double scale = largest(fields.radiosity);
  if (!(scale > 0)) return worst;
  for (std::size_t k = 0; k < falling_.size(); ++k) {
    if (dark_[k]) continue;
    const double off =
        emitted_[k] + (1 - emissivity_[k]) * fields.irradiance[k] - fields.radiosity[k];
    worst.radiosity = std::max(worst.radiosity, std::abs(off) / scale);
  }
  for (std::size_t n = 0; n < x_.size(); ++n) {
    if (!(gain_[n] > 0)) continue;
    double heat = heatWithoutLight(n);
    for (const Index i : nodes_.nodes[n].rows) {
      for (std::size_t b = 0; b < width_; ++b) {
        heat += area_[i] * emissivity_[i * width_ + b] * fields.irradiance[i * width_ + b];
      }
    }
    worst.balance = std::max(worst.balance, std::abs(heat) / (nodes_.nodes[n].area * scale));
  }
  return worst;
}

HeatSolution HeatSolve::run() {
  HeatFields fields;
  Residuals residuals;
  std::size_t products = 0;
  int iterations = 0;
  const double tolerance = std::max(kRounding, kLinearShare * options_.tolerance);
  do {
    const HeatSystem s = system(fields.irradiance);
    fields = solveHeatSystem(*factors_.matrix, s, fields.irradiance, tolerance, progress_);
    products += fields.products;
    step(s, fields);
    residuals = this->residuals(fields);
    ++iterations;
  } while (residuals.worst() > options_.tolerance && std::isfinite(residuals.worst()) &&
           iterations < options_.max_iterations);
  requireTables();
  HeatSolution solution = solutionOf(std::move(fields));
  HeatSummary& summary = solution.summary;
  summary.iterations = iterations;
  summary.linear_steps = products;
  summary.residual = residuals.radiosity;
  summary.balance_residual = residuals.balance;
  const bool good = residuals.worst() <= options_.tolerance;
  summary.status = good ? HeatStatus::converged : HeatStatus::no_convergence;
  summary.message =
      good ? fmt::format(
                 "converged in {} iteration{}: residual {:.1e}, heat balance {:.1e}; usable",
                 iterations, iterations == 1 ? "" : "s", residuals.radiosity, residuals.balance)
           : fmt::format(
                 "not converged after {} iterations: residual {:.1e}, heat balance {:.1e}, "
                 "asked for {:.1e}; not usable; allow more iterations or a larger tolerance",
                 iterations, residuals.radiosity, residuals.balance, options_.tolerance);
  if (good && factors_.seeNothing()) summary.message += fmt::format("; {}", factors_.condition());
  judgeBalance(solution);
  return solution;
}

}  // namespace radiosity
