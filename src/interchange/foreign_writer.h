// What writers of scenes of other renderers do alike, whatever the format.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "interchange/exported_parts.h"

namespace radiosity {

/// Takes lights apart by kind, and notes what the other program is not told.
class ForeignWriter {
 public:
  ForeignWriter(const ForeignWriter&) = delete;
  ForeignWriter& operator=(const ForeignWriter&) = delete;

 protected:
  /// An image of the sky, as the program maps it.
  struct SkyPixels {
    int width;
    int height;
    Vec3 (*direction)(int column, int row);  ///< unit
  };

  /// `program`: its name in notes. Keeps `scene` and `picture` by reference.
  ForeignWriter(const Scene& scene, const ForeignPicture& picture, std::string program);
  ~ForeignWriter() = default;

  const Scene& scene() const { return scene_; }
  const ForeignPicture& picture() const { return picture_; }
  void line(const std::string& text) { made_.text += text + "\n"; }
  void note(const std::string& text);
  void addFile(std::string name, std::vector<std::byte> bytes);
  /// Adds the image of the reflectance of a material that has a texture. Returns its file's name.
  std::string addReflectance(std::size_t material);
  /// All lights without a surface.
  void addLights();
  /// What was made, with notes of losses that no format avoids. Called last.
  ForeignScene finish();

 private:
  virtual void addPoint(const PointLight& point, const Vec3& intensity) = 0;
  virtual void addSpot(const SpotLight& spot, const Vec3& intensity) = 0;
  /// How a spot falls off there, unlike here.
  virtual std::string fallOff() const = 0;
  virtual void addSun(const Sun& sun, const Vec3& irradiance) = 0;
  virtual SkyPixels skyPixels() const = 0;
  virtual void addSkyImage(const std::string& file) = 0;
  virtual void addUniformSky(const Vec3& radiance) = 0;
  void addLight(const Light& light);
  void addSky();

  const Scene& scene_;
  const ForeignPicture& picture_;
  std::string program_;
  ForeignScene made_;
};

}  // namespace radiosity
