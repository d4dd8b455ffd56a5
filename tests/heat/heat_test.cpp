// Radiative heat exchange against closed forms and published values.
#include "radiosity/heat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "heat/conditions.h"
#include "heat/linear_system.h"
#include "solve/solve_systems.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

using test::Matrix;

HeatCondition fluxed(const std::string& name, double emissivity, double flux) {
  HeatCondition c = test::condition(name, emissivity);
  c.flux = flux;
  return c;
}

HeatSolution solved(const FormFactors& factors, const std::vector<HeatCondition>& conditions,
                    const HeatOptions& options = {}, const std::vector<Index>& twin = {}) {
  std::vector<Index> of_row(conditions.size());
  for (Index i = 0; i < of_row.size(); ++i) of_row[i] = i;
  Progress quiet;
  return solveHeat(factors, HeatRows{conditions, of_row, twin}, options, quiet);
}

FormFactors facingPlates() {
  Matrix f(2, 2);
  f << 0, 1, 1, 0;
  return test::factorsFrom(f, {1, 1});
}

double sigmaT4(double temperature) { return kStefanBoltzmann * std::pow(temperature, 4); }

TEST(Heat, SigmaFollowsFromTheExactConstantsOfTheSi) {
  const double h = 6.62607015e-34;
  const double c = 299792458;
  const double k = 1.380649e-23;
  const double pi = std::numbers::pi;
  EXPECT_NEAR(kStefanBoltzmann / (2 * std::pow(pi, 5) * std::pow(k, 4) / (15 * h * h * h * c * c)),
              1, 1e-14);  // a dozen roundings
}

// q = sigma (T1^4 - T2^4) / (1/eps1 + 1/eps2 - 1), Howell, Menguc & Siegel, "Thermal Radiation Heat
// Transfer", chapter 5. Differences of numbers of 5e4 in 16 digits.
TEST(Heat, ParallelPlatesHaveTheirClosedForm) {
  const HeatSolution s =
      solved(facingPlates(), {test::at("hot", .8, 1000), test::at("cold", .5, 500)});
  EXPECT_EQ(s.summary.status, HeatStatus::converged);
  EXPECT_EQ(s.summary.iterations, 1);
  EXPECT_NEAR(s.net_flux[0], 23626.56007993512, 1e-9);
  EXPECT_NEAR(s.net_flux[1], -23626.56007993512, 1e-9);
  EXPECT_NEAR(s.summary.balance.imbalance, 0, 1e-9);
  EXPECT_NEAR(s.summary.balance.throughput, 23626.56007993512, 1e-9);
}

// The flux that the plates above have, given for one of them, gives its temperature back; so does
// the power, over the area of the plate.
TEST(Heat, FluxAndPowerGiveTheirTemperature) {
  const HeatSolution s =
      solved(facingPlates(), {fluxed("hot", .8, 23626.56007993512), test::at("cold", .5, 500)});
  EXPECT_NEAR(s.temperature[0], 1000, 1e-10);
  HeatCondition powered = test::condition("hot", .8);
  powered.power = 2 * 23626.56007993512;
  Matrix f(2, 2);
  f << 0, 1, 1, 0;
  const HeatSolution p = solved(test::factorsFrom(f, {2, 2}), {powered, test::at("cold", .5, 500)});
  EXPECT_NEAR(p.temperature[0], 1000, 1e-10);
  EXPECT_NEAR(p.net_flux[0], 23626.56007993512, 1e-8);
}

// Two walls at given temperatures, two adiabatic: published with its own sigma, to 8 digits. Rows
// are divided by their sums.
TEST(Heat, FourSurfacesMatchPublishedValues) {
  Matrix f(4, 4);
  f << 0, .123, .6928, .1841,      //
      .123, 0, .1841, .6928,       //
      .2771, .0736, .4458, .2035,  //
      .0736, .2771, .2035, .4458;
  for (Eigen::Index i = 0; i < 4; ++i) f.row(i) /= f.row(i).sum();
  HeatOptions options;
  options.sigma = 5.670367e-8;
  const HeatSolution s = solved(test::factorsFrom(f, {1, 1, 2.5, 2.5}),
                                {test::at("bottom", 1, 550), test::at("top", .75, 300),
                                 fluxed("left", .5, 0), fluxed("right", .9, 0)},
                                options);
  EXPECT_NEAR(s.radiosity[1], 1127.0277, 5e-5);
  EXPECT_NEAR(s.net_flux[0], 2003.1839, 5e-5);
  EXPECT_NEAR(s.temperature[2], 505.52788, 5e-6);
  EXPECT_NEAR(s.temperature[3], 463.29647, 5e-6);
}

/// Inside a sphere of which a cap is cut away: F_ij = A_j / A of the whole sphere.
FormFactors cavity(double cap, std::size_t n) {
  test::Random random(3);
  std::vector<double> area = random.vector(n, .5, 2);
  double sum = 0;
  for (const double a : area) sum += a;
  const double whole = sum / (1 - cap);
  Matrix f(n, n);
  for (std::size_t j = 0; j < n; ++j) f.col(Eigen::Index(j)).setConstant(area[j] / whole);
  return test::factorsFrom(f, area);
}

// With F uniform J is uniform: J = eps E + (1 - eps) (1 - a) J, a the cap's share of the sphere. A
// flat aperture sees the cavity alone, so eps_eff = J / E = eps / (eps + (1 - eps) a); and
// a = A_aperture / A_cavity of a spherical cavity. (Gouffe 1945; Sparrow & Cess, 6-3.)
TEST(Heat, SphericalCavityHasItsEffectiveEmissivity) {
  for (const double cap : {.01, .2}) {
    for (const double emissivity : {.1, .7}) {
      const FormFactors factors = cavity(cap, 12);
      const HeatSolution s =
          solved(factors, std::vector<HeatCondition>(12, test::at("wall", emissivity, 700)));
      const double effective = emissivity / (emissivity + (1 - emissivity) * cap);
      for (const double j : s.radiosity) EXPECT_NEAR(j / sigmaT4(700), effective, 1e-13);
      // The power that leaves is that of the aperture at that emissivity: a of the whole sphere
      // times (1 - a) of it, flat.
      double area = 0;
      for (const double a : factors.matrix->area()) area += a;
      EXPECT_NEAR(s.summary.balance.radiated / (effective * sigmaT4(700) * cap * area), 1, 1e-12);
      EXPECT_NEAR(s.summary.balance.to_sky / s.summary.balance.radiated, 1, 1e-12);
    }
  }
}

TEST(Heat, SkyAtTheTemperatureOfTheWallsTakesNothing) {
  HeatOptions options;
  options.sky_temperature = 350;
  const HeatSolution s =
      solved(cavity(.2, 12), std::vector<HeatCondition>(12, test::at("wall", .3, 350)), options);
  for (const double q : s.net_flux) EXPECT_NEAR(q, 0, 1e-12 * sigmaT4(350));
  const HeatSolution a =
      solved(cavity(.2, 12), std::vector<HeatCondition>(12, fluxed("wall", .3, 0)), options);
  for (const double t : a.temperature) EXPECT_NEAR(t, 350, 1e-10);
}

// n sheets of the plates' emissivity, each with one temperature on both sides, divide the flux by n
// + 1; sigma T^4 of the sheets falls in equal steps, with no step between the sheets' sides.
TEST(Heat, ShieldsDivideTheFlux) {
  for (const int n : {1, 2, 5}) {
    const Eigen::Index rows = 2 * n + 2;
    Matrix f = Matrix::Zero(rows, rows);
    for (Eigen::Index k = 0; k < rows; k += 2) f(k, k + 1) = f(k + 1, k) = 1;
    std::vector<HeatCondition> conditions{test::at("hot", .3, 900)};
    std::vector<Index> twin{kNone};
    std::vector<Index> of_row{0};
    for (int k = 0; k < n; ++k) {
      conditions.push_back(fluxed("shield", .3, 0));
      of_row.insert(of_row.end(), 2, Index(k + 1));
      twin.push_back(Index(2 * k + 2));
      twin.push_back(Index(2 * k + 1));
    }
    conditions.push_back(test::at("cold", .3, 300));
    of_row.push_back(Index(n + 1));
    twin.push_back(kNone);
    Progress quiet;
    const HeatSolution s =
        solveHeat(test::factorsFrom(f, std::vector<double>(std::size_t(rows), 1.0)),
                  HeatRows{conditions, of_row, twin}, {}, quiet);
    const double alone = (sigmaT4(900) - sigmaT4(300)) / (2 / .3 - 1);
    EXPECT_NEAR(s.net_flux[0] / alone, 1.0 / (n + 1), 1e-12);
    for (int k = 0; k < n; ++k) {
      EXPECT_EQ(s.temperature[std::size_t(2 * k + 1)], s.temperature[std::size_t(2 * k + 2)]);
      const double expected = sigmaT4(900) - (sigmaT4(900) - sigmaT4(300)) * (k + 1) / (n + 1);
      EXPECT_NEAR(sigmaT4(s.temperature[std::size_t(2 * k + 1)]) / expected, 1, 1e-12);
    }
  }
}

// GMRES has a step for each of a hundred sheets, which only see their neighbours.
TEST(Heat, IterationReachesThroughAHundredSheets) {
  const std::size_t n = 202;
  Matrix f = Matrix::Zero(Eigen::Index(n), Eigen::Index(n));
  for (Eigen::Index k = 0; k < f.rows(); k += 2) f(k, k + 1) = f(k + 1, k) = 1;
  const FormFactors factors = test::factorsFrom(f, std::vector<double>(n, 1.0));
  HeatSystem system;
  system.source.assign(n, 0.0);
  system.source.front() = 1;
  system.falling.assign(n, 0.0);
  system.reflected.assign(n, .7);
  system.reflected.front() = system.reflected.back() = 0;
  system.emits.assign(n, .5);
  system.emits.front() = system.emits.back() = 0;
  system.absorbs.assign(n, .3);
  system.node.assign(n, kNone);
  system.nodes = 100;
  for (Index i = 1; i + 1 < n; ++i) system.node[i] = (i - 1) / 2;
  Progress quiet;
  const auto direct =
      solveHeatSystem(*factors.matrix, system, {}, 1e-12, quiet, LinearMethod::direct);
  const auto steps =
      solveHeatSystem(*factors.matrix, system, {}, 1e-12, quiet, LinearMethod::iterative);
  // The residual, 1e-12, over the least eigenvalue, which is above 1/n^2 of .3.
  EXPECT_LT(test::largestDifference(direct.irradiance, steps.irradiance), 1e-7);
  EXPECT_LT(steps.products, 250u);
}

// One wall of the unit cube has a temperature, all others are adiabatic.
TEST(Heat, AdiabaticRoomIsIsothermal) {
  std::vector<HeatCondition> conditions(6, fluxed("wall", .4, 0));
  conditions[2] = test::at("heater", .05, 612);
  const HeatSolution s =
      solved(test::factorsFrom(test::cube(), std::vector<double>(6, 1.0)), conditions);
  for (const double t : s.temperature) EXPECT_NEAR(t, 612, 612e-10);
  EXPECT_NEAR(s.net_flux[2], 0, 1e-10 * sigmaT4(612));
}

// Directly and by GMRES, for bands of their own emissivities and nodes across rows and bands.
TEST(Heat, DirectAndIterativeSolutionsAgree) {
  test::Random random(7);
  const std::size_t n = 90;
  const auto [f, area] = test::reciprocal(n, random);
  const FormFactors factors = test::symmetricFactorsFrom(f, area);
  HeatSystem system;
  system.bands = 2;
  system.source = random.vector(n * 2, 0, 10);
  system.falling = random.vector(n * 2, 0, 1);
  system.node.assign(n, kNone);
  system.nodes = 30;
  for (Index i = 0; i < 60; ++i) system.node[i] = i / 2;
  std::vector<double> emissivity = random.vector(n * 2, 0, 1);
  std::vector<double> gain(system.nodes, 0.0);
  for (std::size_t k = 0; k < n * 2; ++k) {
    system.reflected.push_back(1 - emissivity[k]);
    system.absorbs.push_back(area[k / 2] * emissivity[k]);
    if (k < 120) gain[k / 4] += system.absorbs.back() / 2;
  }
  for (std::size_t k = 0; k < n * 2; ++k) {
    system.emits.push_back(k < 120 ? emissivity[k] / 2 / gain[k / 4] : 0);
  }
  Progress quiet;
  const HeatFields direct =
      solveHeatSystem(*factors.matrix, system, {}, 1e-13, quiet, LinearMethod::direct);
  const HeatFields iterative =
      solveHeatSystem(*factors.matrix, system, {}, 1e-13, quiet, LinearMethod::iterative);
  EXPECT_EQ(direct.products, 0);
  EXPECT_GT(iterative.products, 3);
  double largest = 0;
  for (const double j : direct.radiosity) largest = std::max(largest, j);
  // The residual, 1e-13 of the largest, over the least eigenvalue: rows sum to .5 to 1.
  EXPECT_LT(test::largestDifference(direct.radiosity, iterative.radiosity), 1e-10 * largest);
}

// q = eps sigma (T^4 - Tsky^4) + h (T - Tinf) of a plate that sees nothing but the sky.
TEST(Heat, APlateExchangesHeatWithSkyAndAir) {
  FormFactors plate = test::factorsFrom(Matrix::Zero(1, 1), {2.5});
  HeatOptions options;
  options.sky_temperature = 255;
  options.tolerance = 1e-12;
  for (const double t : {180.0, 290.0, 900.0}) {
    HeatCondition c = test::condition("plate", .85);
    c.convection = 12;
    c.ambient = 293;
    c.flux = .85 * (sigmaT4(t) - sigmaT4(255)) + 12 * (t - 293);
    const HeatSolution s = solved(plate, {c}, options);
    EXPECT_EQ(s.summary.status, HeatStatus::converged);
    EXPECT_NEAR(s.temperature[0], t, 1e-9 * t);
    EXPECT_NEAR(s.net_flux[0], .85 * (sigmaT4(t) - sigmaT4(255)), 1e-8 * sigmaT4(t));
    EXPECT_NEAR(s.convection[0], 12 * (t - 293), 1e-7);
    EXPECT_NEAR(s.summary.balance.convected, 2.5 * 12 * (t - 293), 1e-6);
  }
}

TEST(Heat, SurfaceThatOnlyConvectsHasTheAirsTemperature) {
  HeatCondition mirror = test::condition("mirror", 0);
  mirror.convection = 5;
  mirror.ambient = 280;
  mirror.flux = 50;
  const HeatSolution s = solved(facingPlates(), {mirror, test::at("cold", .5, 500)});
  EXPECT_NEAR(s.temperature[0], 290, 1e-6);  // 280 + 50 / 5
  EXPECT_NEAR(s.radiosity[0], s.irradiance[0], 1e-9);
}

TEST(Heat, AnAdiabaticMirrorHasNoTemperature) {
  const HeatSolution s =
      solved(facingPlates(), {test::condition("mirror", 0), test::at("cold", .5, 500)});
  EXPECT_TRUE(s.summary.usable());
  EXPECT_EQ(s.summary.undetermined, 1u);
  EXPECT_TRUE(std::isnan(s.temperature[0]));
  EXPECT_NEAR(s.radiosity[0], sigmaT4(500), 1e-9);
}

// At the wavelength of Wien's law a quarter is below, at 4107.2 um K a half (Howell, Menguc &
// Siegel, table A-5); and integrals of Planck's law by Simpson's rule.
TEST(Heat, BandFractionIsTheIntegralOfPlancksLaw) {
  EXPECT_NEAR(blackbodyFraction(1, 2897.771955), .25006, 2e-5);
  EXPECT_NEAR(blackbodyFraction(4.1072, 1000), .5, 2e-5);
  const double c2 = 14387.768775039338;
  for (const double product : {700.0, 3000.0, 14387.0, 14389.0, 60000.0, 1e6}) {
    // In z = c2 / (wavelength T) the fraction is 15/pi^4 times the integral of z^3 / (e^z - 1)
    // from c2 / product on; 120 beyond it nothing is left in 16 digits.
    const double from = c2 / product;
    const int steps = 400000;
    const double width = 120.0 / steps;
    double sum = 0;
    for (int k = 0; k <= steps; ++k) {
      const double z = from + k * width;
      const double weight = k == 0 || k == steps ? 1 : k % 2 == 1 ? 4 : 2;
      sum += weight * z * z * z / std::expm1(z);
    }
    const double integral = sum * width / 3 * 15 / std::pow(std::numbers::pi, 4);
    EXPECT_NEAR(blackbodyFraction(product / 300, 300), integral, 1e-12) << product;
  }
}

// Bands that all have the grey emissivity are the grey problem, cut up.
TEST(Heat, BandsOfOneEmissivityAreGrey) {
  std::vector<HeatCondition> conditions(6, fluxed("wall", .4, 0));
  conditions[0] = test::at("hot", .6, 1400);
  conditions[1] = test::at("cold", .9, 300);
  conditions[4] = fluxed("heated", .2, 3e3);
  conditions[5].convection = 20;
  conditions[5].ambient = 320;
  const FormFactors room = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  HeatOptions options;
  options.tolerance = 1e-12;
  const HeatSolution grey = solved(room, conditions, options);
  ASSERT_EQ(grey.summary.status, HeatStatus::converged);
  for (const bool edges : {true, false}) {
    if (edges) options.bands.edges = {1.5, 3, 8};
    if (!edges) options.bands = {{}, {.2, .5, .3}};
    const HeatSolution banded = solved(room, conditions, options);
    ASSERT_EQ(banded.summary.status, HeatStatus::converged) << banded.summary.message;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(banded.temperature[i] / grey.temperature[i], 1, 1e-10);
      EXPECT_NEAR(banded.net_flux[i], grey.net_flux[i], 1e-10 * sigmaT4(1400));
      double all = 0;
      for (std::size_t b = 0; b < std::size_t(banded.bands); ++b) {
        all += banded.radiosity[i * std::size_t(banded.bands) + b];
      }
      EXPECT_NEAR(all / grey.radiosity[i], 1, 1e-10);
    }
  }
}

// Between plates each band has its own q_k = (E_k1 - E_k2) / (1/eps_k1 + 1/eps_k2 - 1), with or
// without an adiabatic sheet, at whose temperature both sides' sums over bands agree.
TEST(Heat, BandsExchangeBetweenPlatesAndThroughASheet) {
  HeatOptions options;
  options.bands.edges = {4};
  options.tolerance = 1e-12;
  const auto banded = [](HeatCondition c, double low, double high) {
    c.emissivity = {{{}, {low}}, {{}, {high}}};
    return c;
  };
  const auto power = [](std::size_t band, double t) {
    const double below = blackbodyFraction(4, t);
    return sigmaT4(t) * (band == 0 ? below : 1 - below);
  };
  const double eps[3][2] = {{.9, .2}, {.1, .8}, {.5, .3}};  // hot, sheet, cold
  const auto exchange = [&](int a, double ta, int b, double tb) {
    double q = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      q += (power(k, ta) - power(k, tb)) / (1 / eps[a][k] + 1 / eps[b][k] - 1);
    }
    return q;
  };
  const HeatSolution plates =
      solved(facingPlates(),
             {banded(test::at("hot", 1, 1200), .9, .2), banded(test::at("cold", 1, 400), .5, .3)},
             options);
  EXPECT_NEAR(plates.net_flux[0] / exchange(0, 1200, 2, 400), 1, 1e-12);

  Matrix f = Matrix::Zero(4, 4);
  f(0, 1) = f(1, 0) = f(2, 3) = f(3, 2) = 1;
  const std::vector<HeatCondition> conditions{banded(test::at("hot", 1, 1200), .9, .2),
                                              banded(test::condition("sheet", 1), .1, .8),
                                              banded(test::at("cold", 1, 400), .5, .3)};
  const std::vector<Index> of_row{0, 1, 1, 2};
  const std::vector<Index> twin{kNone, 2, 1, kNone};
  Progress quiet;
  const HeatSolution s = solveHeat(test::factorsFrom(f, std::vector<double>(4, 1.0)),
                                   HeatRows{conditions, of_row, twin}, options, quiet);
  ASSERT_EQ(s.summary.status, HeatStatus::converged) << s.summary.message;
  double low = 400;
  double high = 1200;
  for (int k = 0; k < 100; ++k) {
    const double t = (low + high) / 2;
    (exchange(0, 1200, 1, t) > exchange(1, t, 2, 400) ? low : high) = t;
  }
  EXPECT_NEAR(s.temperature[1], low, 1e-8);
  EXPECT_NEAR(s.net_flux[0] / exchange(0, 1200, 1, low), 1, 1e-9);
}

// eps(T) is read at the plate's final T: q = eps(T) sigma T^4 to a sky of 0 K.
TEST(Heat, EmissivityFollowsItsTable) {
  HeatCondition c = fluxed("plate", 0, 0);
  c.emissivity = {{{300, 500, 900}, {.2, .3, .7}}};
  const FormFactors plate = test::factorsFrom(Matrix::Zero(1, 1), {1});
  for (const auto& [t, e] : {std::pair(400.0, .25), std::pair(700.0, .5)}) {
    c.flux = e * sigmaT4(t);
    const HeatSolution s = solved(plate, {c});
    EXPECT_EQ(s.summary.status, HeatStatus::converged);
    EXPECT_NEAR(s.temperature[0], t, 1e-8 * t);
  }
  c.flux = sigmaT4(1000);
  EXPECT_NE(test::errorOf([&] { solved(plate, {c}); }).find("plate: reaches"), std::string::npos);
}

// Where d ln eps / d ln T > 4, taking eps from the step before would diverge; at the corners of the
// table Newton's method alone would go round in circles.
TEST(Heat, EmissivityMayRiseSteeply) {
  HeatCondition c = fluxed("plate", 0, 0);
  const FormFactors plate = test::factorsFrom(Matrix::Zero(1, 1), {1});
  const std::vector<Emissivity> tables = {{{200, 335, 345, 600}, {.3, .3, .8, .8}},
                                          {{200, 330, 360, 600}, {.3, .3, .8, .8}},
                                          {{200, 300, 350, 600}, {.1, .1, .5, .5}},
                                          {{200, 335, 335.01, 600}, {.05, .05, .95, .9}}};
  for (const Emissivity& table : tables) {
    c.emissivity = {table};
    for (const double t : {250.0, 300.5, 331.0, 335.0, 335.005, 340.0, 345.0, 359.0, 500.0}) {
      c.flux = table.at(t) * sigmaT4(t);
      const HeatSolution s = solved(plate, {c});
      EXPECT_EQ(s.summary.status, HeatStatus::converged) << s.summary.message << " at " << t;
      EXPECT_NEAR(s.temperature[0], t, 1e-8 * t);  // the balance holds to 1e-9
    }
  }
}

// Two coatings that face each other: q between them has its closed form, and each gives off what is
// supplied to it.
TEST(Heat, SteepEmissivitiesExchangeHeat) {
  const Emissivity table = {{200, 335, 345, 900}, {.1, .1, .9, .9}};
  HeatOptions options;
  options.sky_temperature = 250;
  for (const double supplied : {50.0, 300.0, 700.0}) {
    HeatCondition a = fluxed("a", 0, supplied);
    HeatCondition b = fluxed("b", 0, supplied / 3);
    a.emissivity = b.emissivity = {table};
    Matrix f = Matrix::Zero(2, 2);
    f << 0, .4, .4, 0;
    const FormFactors factors = test::factorsFrom(f, {1, 1});
    const HeatSolution s = solved(factors, {a, b}, options);
    ASSERT_EQ(s.summary.status, HeatStatus::converged) << s.summary.message;
    double j[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const double eps = table.at(s.temperature[i]);
      j[i] = eps * sigmaT4(s.temperature[i]) + (1 - eps) * s.irradiance[i];
      EXPECT_NEAR(s.radiosity[i], j[i], 1e-6);
    }
    const double sky = .6 * sigmaT4(250);
    EXPECT_NEAR(j[0] - (.4 * j[1] + sky), supplied, 1e-5);
    EXPECT_NEAR(j[1] - (.4 * j[0] + sky), supplied / 3, 1e-5);
  }
}

// A surface of uneven rows at one temperature: its power is what both give off.
TEST(Heat, IsothermalSurfaceSharesItsPower) {
  HeatCondition c = test::condition("heater", .8);
  c.power = 1000;
  c.isothermal = true;
  Matrix f = Matrix::Zero(3, 3);
  f << 0, 0, .5, 0, 0, .1, .1, .06, 0;
  const std::vector<HeatCondition> conditions{c, test::at("wall", .5, 300)};
  const std::vector<Index> of_row{0, 0, 1};
  Progress quiet;
  const HeatSolution s =
      solveHeat(test::factorsFrom(f, {1, 3, 5}), HeatRows{conditions, of_row, {}}, {}, quiet);
  EXPECT_EQ(s.temperature[0], s.temperature[1]);
  EXPECT_NEAR(s.net_flux[0] + 3 * s.net_flux[1], 1000, 1e-9);
  EXPECT_GT(std::abs(s.net_flux[0] - s.net_flux[1]), 1);
}

TEST(Heat, ValuesBeyondAllBoundsAreNoSolution) {
  const std::string message = test::errorOf([] {
    solved(facingPlates(), {test::at("a", .5, 1e99), test::at("b", .5, 300)});
  });
  EXPECT_NE(message.find("a: temperature 1e+99 is not one in kelvin, 0 to 1e+08"),
            std::string::npos)
      << message;
  // 1e24 W/m^2 leave a surface of emissivity 1e-300: sigma T^4 would be 1e324.
  const HeatSolution none =
      solved(facingPlates(), {fluxed("a", 1e-300, 1e24), test::at("b", .5, 300)});
  EXPECT_FALSE(none.summary.usable()) << none.summary.message;
}

TEST(Heat, RefusesConditionsWithoutATemperature) {
  const FormFactors plates = facingPlates();
  const auto error = [&](const std::vector<HeatCondition>& conditions) {
    return test::errorOf([&] { solved(plates, conditions); });
  };
  const auto says = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says(error({fluxed("a", .5, 10), fluxed("b", .5, 10)}), "temperatures of a, b have no level");
  says(error({fluxed("a", .5, 10), fluxed("b", .5, 10)}), "20 W in all");
  says(error({fluxed("a", .5, 0), fluxed("b", .5, 0)}), "no level");
  says(error({fluxed("a", .5, 0), test::at("b", 0, 300)}), "temperatures of a have no level");
  says(error({fluxed("a", 0, 10), test::at("b", .5, 300)}), "a: has emissivity 0");
  says(error({fluxed("a", .5, -1e4), test::at("b", .5, 300)}), "a: more heat is taken out");
  HeatCondition cold = fluxed("a", .5, -1e4);
  cold.convection = 3;
  cold.ambient = 300;
  says(error({cold, test::at("b", .5, 300)}), "a: more heat is taken out");
  // The heat is taken out of b, which takes it from a.
  says(error({fluxed("a", .5, 0), fluxed("b", .5, -1e4)}), "no level");
  HeatCondition airy = fluxed("a", .5, 0);
  airy.convection = 5;
  airy.ambient = 300;
  says(error({airy, fluxed("b", .5, -3000)}), "b: more heat is taken out of it (3000 W/m^2)");
  HeatCondition both = test::at("a", .5, 300);
  both.flux = 1;
  says(error({both, test::at("b", .5, 300)}),
       "a: has more than one of temperature, flux and power");
  says(error({test::at("a", 1.5, 300), test::at("b", .5, 300)}),
       "a: emissivity 1.5 is not within 0 and 1");
  says(error({test::at("a", .5, -3), test::at("b", .5, 300)}), "a: temperature -3");
}

// A surface that nothing lights and nothing heats is at 0 K, and that is no error.
TEST(Heat, AdiabaticPlateUnderAColdSkyIsAtZero) {
  const HeatSolution s = solved(test::factorsFrom(Matrix::Zero(1, 1), {1}), {fluxed("a", .5, 0)});
  EXPECT_TRUE(s.summary.usable());
  EXPECT_EQ(s.temperature[0], 0);
  // The same with a table of emissivity, for which the solution is iterated.
  HeatCondition c = fluxed("a", 0, 0);
  c.emissivity = {{{0, 300}, {.3, .5}}};
  const HeatSolution cold = solved(facingPlates(), {c, test::at("b", .5, 0)});
  EXPECT_TRUE(cold.summary.usable());
  EXPECT_EQ(cold.temperature[0], 0);
  EXPECT_EQ(cold.radiosity[0], 0);
}

}  // namespace
}  // namespace radiosity
