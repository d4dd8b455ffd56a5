#include "heat/linear_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "solve/iteration.h"
#include "solve/krylov.h"

namespace radiosity {

namespace {

/// The steps of GMRES between two restarts: as many as there is room for vectors. A chain of n
/// rooms, or of n sheets, needs n steps.
int mostSteps(std::size_t unknowns) {
  constexpr std::size_t kNumbers = std::size_t(1) << 25;  // 256 MiB
  return int(std::clamp<std::size_t>(kNumbers / std::max<std::size_t>(unknowns, 1), 30, 300));
}
/// The most restarts. A round that does not halve the residual ends them: the rest is rounding.
constexpr int kMostRounds = 50;

Eigen::Map<const Eigen::VectorXd> asVector(const std::vector<double>& values) {
  return {values.data(), Eigen::Index(values.size())};
}

std::vector<double> received(const ExchangeOperator& matrix, const std::vector<double>& radiosity,
                             int bands) {
  std::vector<double> irradiance(radiosity.size(), 0.0);
  matrix.product(radiosity, bands, irradiance);
  return irradiance;
}

/// The dense matrix, column by column: H_ik = sum over j, l of [F_ij reflected_jk (k = l) + P_ik
/// absorbs_jl] H_jl, with P_ik = sum over the rows m of j's node of F_im emits_mk.
class DenseSystem {
 public:
  DenseSystem(const ExchangeOperator& matrix, const HeatSystem& system)
      : system_(system),
        rows_(Eigen::Index(matrix.size())),
        bands_(Eigen::Index(system.bands)),
        values_(matrix.dense()),
        factors_(values_.data(), rows_, rows_),
        members_(system.nodes) {
    for (std::size_t j = 0; j < system.node.size(); ++j) {
      if (system.node[j] != kNone) members_[system.node[j]].push_back(Eigen::Index(j));
    }
  }

  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(rows_ * bands_, rows_ * bands_);
    for (Eigen::Index j = 0; j < rows_; ++j) {
      for (Eigen::Index k = 0; k < bands_; ++k) {
        const double reflected = system_.reflected[std::size_t(j * bands_ + k)];
        for (Eigen::Index i = 0; i < rows_; ++i) {
          m(i * bands_ + k, j * bands_ + k) -= factors_(i, j) * reflected;
        }
      }
    }
    for (const auto& members : members_) subtractNode(members, m);
    return m;
  }

 private:
  void subtractNode(const std::vector<Eigen::Index>& members, Eigen::MatrixXd& m) const {
    Eigen::VectorXd seen = Eigen::VectorXd::Zero(rows_ * bands_);
    for (const Eigen::Index j : members) {
      for (Eigen::Index k = 0; k < bands_; ++k) {
        const double emits = system_.emits[std::size_t(j * bands_ + k)];
        for (Eigen::Index i = 0; i < rows_; ++i) seen[i * bands_ + k] += factors_(i, j) * emits;
      }
    }
    for (const Eigen::Index j : members) {
      for (Eigen::Index c = j * bands_; c < (j + 1) * bands_; ++c) {
        m.col(c) -= system_.absorbs[std::size_t(c)] * seen;
      }
    }
  }

  const HeatSystem& system_;
  Eigen::Index rows_;
  Eigen::Index bands_;
  std::vector<double> values_;
  Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> factors_;
  std::vector<std::vector<Eigen::Index>> members_;  ///< rows of each node
};

/// The constant c of H = L H + c.
std::vector<double> constantOf(const ExchangeOperator& matrix, const HeatSystem& system) {
  std::vector<double> constant = received(matrix, system.source, system.bands);
  for (std::size_t k = 0; k < constant.size(); ++k) constant[k] += system.falling[k];
  return constant;
}

std::vector<double> solveDirectly(const ExchangeOperator& matrix, const HeatSystem& system) {
  const std::vector<double> constant = constantOf(matrix, system);
  const Eigen::VectorXd solved =
      DenseSystem(matrix, system).matrix().partialPivLu().solve(asVector(constant));
  return {solved.data(), solved.data() + solved.size()};
}

class Gmres {
 public:
  Gmres(const ExchangeOperator& matrix, const HeatSystem& system, Progress& progress)
      : matrix_(matrix),
        system_(system),
        constant_(constantOf(matrix, system)),
        most_steps_(mostSteps(constant_.size())),
        progress_(progress) {}

  void improve(std::vector<double>& irradiance, double tolerance) {
    Convergence shown(tolerance, most_steps_ * kMostRounds, "heat exchange", progress_);
    double last = INFINITY;
    for (int round = 0; round < kMostRounds; ++round) {
      const Eigen::VectorXd step = stepFrom(irradiance);
      const double off = step.lpNorm<Eigen::Infinity>();
      const double scale = std::max(asVector(irradiance).lpNorm<Eigen::Infinity>(),
                                    asVector(constant_).lpNorm<Eigen::Infinity>());
      if (off <= tolerance * scale || !(off < last / 2)) return;
      last = off;
      add(correction(step, scale, shown), irradiance);
    }
  }
  std::size_t products() const { return products_; }

 private:
  std::vector<double> applied(const std::vector<double>& irradiance) {
    progress_.check();
    ++products_;
    return received(matrix_, system_.sentBack(irradiance), system_.bands);
  }

  Eigen::VectorXd stepFrom(const std::vector<double>& irradiance) {
    const std::vector<double> image = applied(irradiance);
    return asVector(image) + asVector(constant_) - asVector(irradiance);
  }

  Eigen::VectorXd correction(const Eigen::VectorXd& step, double scale, Convergence& shown) {
    Krylov krylov(step);
    for (int k = 0; k < most_steps_ && !krylov.exhausted(); ++k) {
      const Eigen::VectorXd& d = krylov.direction();
      const std::vector<double> image = applied({d.data(), d.data() + d.size()});
      krylov.add(asVector(image));
      shown.record(krylov.residual().lpNorm<Eigen::Infinity>() / scale);
      if (shown.converged()) break;
    }
    return krylov.correction();
  }

  static void add(const Eigen::VectorXd& correction, std::vector<double>& irradiance) {
    for (std::size_t k = 0; k < irradiance.size(); ++k)
      irradiance[k] += correction[Eigen::Index(k)];
  }

  const ExchangeOperator& matrix_;
  const HeatSystem& system_;
  std::vector<double> constant_;
  int most_steps_;
  Progress& progress_;
  std::size_t products_ = 0;
};

}  // namespace

std::vector<double> HeatSystem::sentBack(const std::vector<double>& irradiance) const {
  const auto width = std::size_t(bands);
  std::vector<double> absorbed(nodes, 0.0);
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    const Index n = node[k / width];
    if (n != kNone) absorbed[n] += absorbs[k] * irradiance[k];
  }
  std::vector<double> sent(irradiance.size());
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    const Index n = node[k / width];
    sent[k] = reflected[k] * irradiance[k] + (n == kNone ? 0 : emits[k] * absorbed[n]);
  }
  return sent;
}

std::vector<double> HeatSystem::radiosityOf(const std::vector<double>& irradiance) const {
  std::vector<double> radiosity = sentBack(irradiance);
  for (std::size_t k = 0; k < radiosity.size(); ++k) radiosity[k] += source[k];
  return radiosity;
}

HeatFields solveHeatSystem(const ExchangeOperator& matrix, const HeatSystem& system,
                           const std::vector<double>& start, double tolerance, Progress& progress,
                           LinearMethod method) {
  const std::size_t unknowns = system.source.size();
  if (method == LinearMethod::automatic) {
    method = unknowns <= kMostDirect ? LinearMethod::direct : LinearMethod::iterative;
  }
  HeatFields fields;
  progress.check();
  if (method == LinearMethod::direct) {
    progress.begin("heat exchange", 1);
    fields.irradiance = solveDirectly(matrix, system);
    progress.end();
  } else {
    fields.irradiance = start.empty() ? std::vector<double>(unknowns, 0.0) : start;
    Gmres gmres(matrix, system, progress);
    gmres.improve(fields.irradiance, tolerance);
    fields.products = gmres.products();
  }
  progress.check();
  fields.radiosity = system.radiosityOf(fields.irradiance);
  return fields;
}

}  // namespace radiosity
