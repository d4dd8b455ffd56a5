// What the program needs of Draco, behind one entry point.
#include "base/draco_codec.h"

#include <draco/compression/decode.h>

#include <cstring>
#include <utility>

namespace radiosity {

namespace {

template <class Number>
DracoValues valuesAs(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  DracoValues values;
  const auto components = std::size_t(attribute.num_components());
  std::vector<Number> numbers(components);
  const std::size_t size = components * sizeof(Number);
  values.bytes.resize(mesh.num_points() * size);
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    if (!attribute.ConvertValue<Number>(attribute.mapped_index(point), numbers.data())) return {};
    std::memcpy(values.bytes.data() + point.value() * size, numbers.data(), size);
  }
  values.components = components;
  return values;
}

class Mesh final : public DracoMesh {
 public:
  explicit Mesh(std::unique_ptr<draco::Mesh> mesh) : mesh_(std::move(mesh)) {}

  std::size_t points() const override { return mesh_->num_points(); }

  std::vector<std::uint32_t> corners() const override {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * std::size_t(mesh_->num_faces()));
    for (draco::FaceIndex face(0); face < mesh_->num_faces(); ++face) {
      for (const draco::PointIndex& point : mesh_->face(face)) corners.push_back(point.value());
    }
    return corners;
  }

  DracoValues values(std::uint32_t id, DracoNumber number) const override {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
    if (attribute == nullptr) return {};
    switch (number) {
      case DracoNumber::int8:
        return valuesAs<std::int8_t>(*mesh_, *attribute);
      case DracoNumber::uint8:
        return valuesAs<std::uint8_t>(*mesh_, *attribute);
      case DracoNumber::int16:
        return valuesAs<std::int16_t>(*mesh_, *attribute);
      case DracoNumber::uint16:
        return valuesAs<std::uint16_t>(*mesh_, *attribute);
      case DracoNumber::uint32:
        return valuesAs<std::uint32_t>(*mesh_, *attribute);
      case DracoNumber::float32:
        return valuesAs<float>(*mesh_, *attribute);
    }
    return {};
  }

 private:
  std::unique_ptr<draco::Mesh> mesh_;
};

class Codec final : public DracoCodec {
 public:
  std::shared_ptr<const DracoMesh> decode(std::span<const unsigned char> bytes) const override {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    return mesh.ok() ? std::make_shared<Mesh>(std::move(mesh).value()) : nullptr;
  }
};

}  // namespace

/// The entry point by which dracoCodec() finds the codec of this library.
extern "C" [[gnu::visibility("default")]] const DracoCodec* radiosityDracoCodec() {
  static const Codec kCodec;
  return &kCodec;
}

}  // namespace radiosity
