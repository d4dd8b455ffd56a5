#include "model.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <filesystem>
#include <limits>

namespace radiosity::property {

std::size_t Model::faceCount() const {
  std::size_t count = 0;
  for (const Part& part : parts) count += part.faces.size();
  return count;
}

double Model::extent() const {
  Vec3 low(std::numeric_limits<double>::max());
  Vec3 high(std::numeric_limits<double>::lowest());
  for (const Part& part : parts) {
    for (const Loop& face : part.faces) {
      for (const Vec3& p : face) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
  }
  const Vec3 size = high - low;
  return std::max({size.x, size.y, size.z, 0.0});
}

void Model::write(const std::string& path) const {
  auto obj = fmt::output_file(path + ".obj");
  auto mtl = fmt::output_file(path + ".mtl");
  obj.print("# {} {}\nmtllib {}.mtl\n", kind, seed,
            std::filesystem::path(path).filename().string());
  std::size_t corner = 0;
  for (const Part& part : parts) {
    if (part.faces.empty()) continue;
    mtl.print("newmtl {0}\nKd {1} {1} {1}\nKe {2} {2} {2}\n", part.name, part.reflectance,
              part.radiance);
    obj.print("o {0}\nusemtl {0}\n", part.name);
    for (const Loop& face : part.faces) {
      for (const Vec3& p : face) obj.print("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
      obj.print("f");
      for (std::size_t k = 0; k < face.size(); ++k) obj.print(" {}", ++corner);
      obj.print("\n");
    }
  }
}

SceneOptions Model::options() const {
  SceneOptions options;
  for (const Part& part : parts) {
    if (part.two_sided && !part.faces.empty()) options.two_sided.push_back(part.name);
  }
  if (sky > 0) options.lights = {uniformSky({sky, sky, sky})};
  return options;
}

std::string Model::command(const std::string& path) const {
  std::string text = fmt::format("solve {}.obj --patches {}", path, patches);
  for (const std::string& name : options().two_sided) text += " --two-sided " + name;
  if (sky > 0) text += fmt::format(" --sky {}", sky);
  if (!exact_emitters) text += " --emitters estimated";
  return text;
}

}  // namespace radiosity::property
