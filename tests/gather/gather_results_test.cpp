// Gathered light in the results file.
#include <gtest/gtest.h>

#include <filesystem>

#include "gather_scenes.h"
#include "radiosity/results.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class GatherResults : public FolderTest {};

Results sampleOf(GatherAt at) {
  Progress quiet;
  Results results;
  results.version = "test";
  results.scene = loadScene(std::string(RADIOSITY_SOURCE_DIR "/data/cornell-box.obj"));
  MeshOptions options;
  options.patches = 60;
  results.mesh = {meshScene(*results.scene, options, quiet), "mesh"};
  GatherOptions gathering;
  gathering.at = at;
  gathering.passes = 3;
  gathering.resolution = 16;
  const PatchMesh& mesh = results.mesh->mesh;
  results.gathered = {gather(mesh, patchMaterials(*results.scene, mesh), gathering, quiet),
                      "at=somewhere"};
  return results;
}

TEST_F(GatherResults, AreReadBackToTheBit) {
  Progress quiet;
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    const Results out = sampleOf(at);
    const std::string path = this->path("g.h5");
    writeResults(path, out, quiet);
    EXPECT_NEAR(double(std::filesystem::file_size(path)), double(estimateResultsBytes(out)), 4096);
    const Results in = readResults(path);
    ASSERT_TRUE(in.gathered);
    const Gathered& a = *out.gathered;
    const Gathered& b = *in.gathered;
    EXPECT_EQ(in.gathered.key, out.gathered.key);
    EXPECT_EQ(a.at, b.at);
    EXPECT_EQ(a.radiosity, b.radiosity);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.backs, b.backs);
    EXPECT_EQ(a.sky, b.sky);
    EXPECT_EQ(a.backs_by_surface, b.backs_by_surface);
    EXPECT_EQ(b.backs_by_surface.size(), in.mesh->mesh.surface_names.size());
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.eye_of_corner, b.eye_of_corner);
    EXPECT_EQ(a.summary.status, b.summary.status);
    EXPECT_EQ(a.summary.message, b.summary.message);
    ASSERT_EQ(b.summary.passes.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const GatherPass& p = a.summary.passes[k];
      const GatherPass& q = b.summary.passes[k];
      EXPECT_EQ(p.change, q.change);
      EXPECT_EQ(p.bound, q.bound);
      EXPECT_EQ(p.in_flight, q.in_flight);
      EXPECT_EQ(p.energy.emitted, q.energy.emitted);
      EXPECT_EQ(p.energy.imbalance, q.energy.imbalance);
    }
  }
}

TEST_F(GatherResults, AreRefusedIfTheyDoNotFitTheMesh) {
  Progress quiet;
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    Results out = sampleOf(at);
    ASSERT_TRUE(out.gathered);
    if (at == GatherAt::patches) {
      out.gathered->area.pop_back();
    } else {
      out.gathered->eye_of_corner.front() = 1000000;
    }
    const std::string path = this->path("g.h5");
    writeResults(path, out, quiet);
    try {
      readResults(path);
      FAIL() << "damaged results were read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("/gather/"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace radiosity
