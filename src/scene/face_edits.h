// Turns faces over and leaves faces out.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// Collects what is to happen to the surfaces of a scene, which only apply() changes.
class FaceEdits {
 public:
  explicit FaceEdits(Scene& scene);

  /// `name`: what the `surfaces` are called in notes.
  void flip(const std::string& name, std::span<const Index> surfaces);
  void leaveOut(const std::string& name, std::span<const Index> surfaces);
  /// Errors: InputError if all faces are to be left out.
  void requireFaces() const;
  /// Notes what is done, with areas. A surface that was named twice is turned over once.
  void apply();

 private:
  enum class What { flip, leave_out };
  struct Edit {
    What what;
    std::string name;
    std::vector<Index> surfaces;
  };
  std::vector<double> areas() const;
  void note(const Edit& edit, std::span<const double> areas,
            std::span<const std::size_t> faces) const;
  void turnFaces();
  void dropFaces();
  void dropSurfaces();

  Scene& scene_;
  std::vector<Edit> edits_;
  std::vector<std::uint8_t> flipped_;   ///< by surface
  std::vector<std::uint8_t> left_out_;  ///< by surface
};

}  // namespace radiosity
