#include <fmt/format.h>

#include <algorithm>

#include "cli/field_lines.h"
#include "cli/summaries.h"
#include "radiosity/names.h"

namespace radiosity::cli {
namespace {

const char* directText(DirectLight direct) {
  switch (direct) {
    case DirectLight::none:
      return "none: nothing shines but, maybe, the sky";
    case DirectLight::exact:
      return "clipped exactly";
    case DirectLight::partly:
      return "clipped exactly, by rays where too much is in between";
    case DirectLight::rays:
      return "by rays to the emitters, which are many";
    case DirectLight::hemispheres:
      break;
  }
  return "with the indirect: there are too many emitters to aim at";
}

/// The largest error, and the way to reduce it.
std::string largestError(const ElementReport& r, double of_matrix) {
  const double most = std::max({r.interpolation_error, r.ray_error, of_matrix});
  if (most <= 0) return "none";
  if (most == of_matrix) return "the matrix (lower --tolerance)";
  if (most == r.ray_error) return "the rays of the indirect light (lower --element-tolerance)";
  return "interpolation (lower --element-tolerance)";
}

void reportMatrixError(Report& report, const FormFactors& factors) {
  if (factors.method == FormFactorMethod::cut) {
    report.number("irradiance_error", "irradiance off by about", factors.report.cut.error());
  } else if (factors.error.empty()) {
    report.text("matrix_error", "error of the matrix",
                "not known by " + nameOf(kFactorsFromNames, factors.method));
  } else {
    report.number("matrix_error", "error of the matrix", factors.report.error_figure);
  }
}

}  // namespace

void summarizeElements(Report& report, const Elements& elements, const FormFactors& factors) {
  const ElementReport& r = elements.report;
  report.section("elements", "Elements");
  FieldLines lines(report);
  lines.after("direct", [&] { report.text("direct", "direct light", directText(r.direct)); });
  lines.after("uniform_vertices", [&] {
    report.largeCount("uniform_vertices", "a uniform grid as fine", r.uniform_vertices);
  });
  lines.after("ray_error", [&] {
    reportMatrixError(report, factors);
    report.text("largest_error", "largest error",
                largestError(r, factors.error.empty() ? 0 : factors.report.error_figure));
  });
  r.describe(lines, r);
}

void summarizeFinalGather(Report& report, const ElementReport& sources,
                          const PixelGatherReport& gathered, const FormFactors& factors) {
  report.section("final_gather", "Final gather");
  report.text("direct", "direct light", directText(sources.direct));
  report.count("emitters", "emitters", sources.emitters);
  report.count("points", "points evaluated", gathered.points);
  report.count("rays_a_pixel", "rays a pixel, at most", std::size_t(gathered.rays_a_pixel));
  report.largeCount("rays", "rays of indirect light", gathered.rays);
  report.number("ray_error", "error of rays, of pixels", gathered.ray_error);
  reportMatrixError(report, factors);
  report.seconds("seconds_sources", "time, sources",
                 sources.seconds_direct + sources.seconds_indirect);
  report.seconds("seconds", "time, pixels", gathered.seconds);
}

}  // namespace radiosity::cli
