// Options of radiative heat exchange.
#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace radiosity::cli {

void addHeatOptions(CLI::App& app, Request& r) {
  add(app, "Heat", "--thermal", r.thermal, "FILE.csv",
      "Conditions by surface, material or object name, or by a pattern of them; * stands for all "
      "others. Of a matrix (.mtx, .vf): by name or number of rows. Columns: surface, "
      "emissivity, temperature_K, flux_W_per_m2 (0: adiabatic), power_W, convection_W_per_m2_K, "
      "ambient_K, isothermal (yes: one temperature)");
  add(app, "Heat", "--condition", r.conditions, "NAME.PROPERTY=VALUE",
      "Replace what the table says, or do without one: emissivity (one number; one a band, 0.8; "
      "0.3; against temperature, 300:0.1 800:0.25; or the word material: 1 - reflectance), "
      "temperature, flux, power, convection, ambient, isothermal. May be repeated");
  add(app, "Heat", "--group", r.groups, "NAME=PATTERN",
      "Join surfaces under one name, for conditions and in tables; * and ? stand for any text and "
      "any character, a surface belongs to the first group that matches it. May be repeated");
  addOptionsOf<HeatOptions>(app, r, "Heat");
  app.get_option("--band-edges")->excludes(app.get_option("--band-fractions"));
  add(app, "Heat", "--patch-table", r.patch_table, "FILE.csv",
      "Write the figures of every patch, beside those of surfaces in -o FILE.csv");
  add(app, "Points", "--point-table", r.point_table, "FILE.csv",
      "Write mean radiant temperatures at the points: of a person standing, seated, and of the six "
      "faces of a small cube, K");
  addAreasOption(app, r, "Heat");
}

}  // namespace radiosity::cli
