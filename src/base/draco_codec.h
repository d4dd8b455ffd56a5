// Meshes that Draco packed. Draco is in a separate library (src/draco), which is opened when the
// first packed mesh is read: Debian's Draco brings a TinyGLTF of another version, which must not
// stand in for the one that the scene's reader uses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace radiosity {

/// How the numbers of an attribute are stored.
enum class DracoNumber { int8, uint8, int16, uint16, uint32, float32 };

/// One value a point, row-major, in bytes.
struct DracoValues {
  std::size_t components = 0;
  std::vector<unsigned char> bytes;
};

class DracoMesh {
 public:
  virtual ~DracoMesh() = default;
  virtual std::size_t points() const = 0;
  /// Points of the triangles, three each.
  virtual std::vector<std::uint32_t> corners() const = 0;
  /// The values of the attribute with this number in the packed data; without components if there
  /// is none, or if its values do not fit into `number`.
  virtual DracoValues values(std::uint32_t attribute, DracoNumber number) const = 0;
};

class DracoCodec {
 public:
  virtual ~DracoCodec() = default;
  /// Null if the bytes are no mesh.
  virtual std::shared_ptr<const DracoMesh> decode(std::span<const unsigned char> bytes) const = 0;
};

/// Opens the library at the first call. Errors: RunError if it is not beside this one or not
/// complete.
const DracoCodec& dracoCodec();

}  // namespace radiosity
