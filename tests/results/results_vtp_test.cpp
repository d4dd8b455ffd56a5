// Patches for ParaView: refusals. vtp_test.py reads files back with VTK.
#include <gtest/gtest.h>

#include "radiosity/vtk.h"
#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class Vtp : public FolderTest {};

TEST_F(Vtp, RefusesFieldsThatDoNotFit) {
  const PatchMesh mesh = sample::mesh(2);
  const std::vector<double> values(mesh.size(), 1.0);
  const auto write = [&](const std::vector<CellField>& fields) {
    return [&, fields] { writeVtp(path("x.vtp"), mesh, fields); };
  };
  expectError<InputError>(path("x.vtp"), "field t has 5 values of 2 components for 5 patches",
                          write({{"t", "K", 2, values}}));
  expectError<InputError>(path("x.vtp"), "0 components", write({{"t", "K", 0, {}}}));
  expectError<InputError>(path("x.vtp"), "two fields t",
                          write({{"t", "K", 1, values}, {"t", "K", 1, values}}));
  expectError<InputError>(path("x.vtp"), "two fields area", write({{"area", "", 1, values}}));
  EXPECT_EQ(files(), 0u);
}

TEST_F(Vtp, IsWrittenWholeOrNotAtAll) {
  const PatchMesh mesh = sample::mesh(17);
  const FullDisk disk(1000);
  expectError<RunError>(path("x.vtp"), "cannot be written",
                        [&] { writeVtp(path("x.vtp"), mesh, {}); });
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace radiosity
