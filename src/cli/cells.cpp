// Writes patches with their quantities: for ParaView, and as a table.
#include "cli/commands.h"
#include "radiosity/matrix_files.h"
#include "radiosity/vtk.h"

namespace radiosity::cli {

void writeCells(Session& session, Pipeline& pipeline, OutputSet& files, const MixedLight* mix) {
  if (!files.has(Format::vtp)) return;
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const Command command = session.request.command;
  const bool heat = command == Command::heat;
  std::vector<CellField> fields =
      heat ? heatFields(pipeline.heat())
           : materialFields(mix != nullptr ? mix->materials : pipeline.materials());
  std::string what = heat ? "patches for ParaView: heat" : "patches for ParaView: materials";
  const auto append = [&](std::vector<CellField> more, const char* name) {
    std::move(more.begin(), more.end(), std::back_inserter(fields));
    what += name;
  };
  if (command != Command::mesh) append(factorFields(pipeline.factors()), ", accounts of rows");
  if (mix != nullptr) {
    append(lightFields(mix->solution, arePhotometric(mix->materials.lights)), ", mixed light");
  } else if (command == Command::solve && !pipeline.solution().radiosity.empty()) {
    append(lightFields(pipeline.solution(), arePhotometric(pipeline.materials().lights)),
           ", light");
  }
  files.write(Format::vtp, what,
              [&](const std::string& temporary) { writeVtp(temporary, mesh, fields); });
}

void writeLightTable(Pipeline& pipeline, const Solution& light, OutputSet& files) {
  if (!files.has(Format::light_csv)) return;
  const PatchMesh& mesh = pipeline.mesh().mesh;
  std::vector<std::string> names;
  names.reserve(mesh.size());
  for (const Index surface : mesh.surface) names.push_back(mesh.surface_names[surface]);
  const bool photometric = arePhotometric(pipeline.materials().lights);
  files.write(Format::light_csv, "light by patch", [&](const std::string& temporary) {
    writeLightCsv(temporary, names, mesh.area, light, photometric);
  });
}

}  // namespace radiosity::cli
