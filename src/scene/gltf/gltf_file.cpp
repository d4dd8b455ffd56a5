#include "scene/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>

#include "base/input_file.h"
#include "scene/gltf/glb_chunks.h"
#include "scene/gltf/gltf_compression.h"
#include "scene/gltf/gltf_photometry.h"
#include "scene/gltf/gltf_preflight.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Keeps the encoded bytes of an image file, since we know only later which images are needed. Does
/// not touch images in a buffer: the library has not checked that they are within it.
bool keepEncoded(tinygltf::Image* image, const int /*index*/, std::string* /*error*/,
                 std::string* /*warning*/, int /*width*/, int /*height*/,
                 const unsigned char* bytes, int size, void* /*user*/) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

template <class T>
double loadAs(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return double(value);
}

double loadComponent(const unsigned char* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return loadAs<std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return loadAs<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return loadAs<std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return loadAs<std::uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return loadAs<std::uint32_t>(bytes);
    default:
      return loadAs<float>(bytes);
  }
}

/// The divisor of integers that stand for fractions (glTF 2.0, 3.6.2.2).
double normalisation(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 65535;
    default:
      return 1;
  }
}

bool isComponentType(int type) {
  constexpr std::array<int, 6> kTypes = {
      TINYGLTF_COMPONENT_TYPE_BYTE,         TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
      TINYGLTF_COMPONENT_TYPE_SHORT,        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_COMPONENT_TYPE_FLOAT};
  return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

bool isIndexType(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// The library's access to files beside the scene: only regular files, with literal names (its own
// functions expand names like a shell).
bool isFile(const std::string& path, void* /*user*/) { return whyNotAFile(path).empty(); }

std::string asItStands(const std::string& path, void* /*user*/) { return path; }

bool readBytes(std::vector<unsigned char>* out, std::string* error, const std::string& path,
               void* /*user*/) {
  try {
    const std::string content = readWholeFile(path);
    out->assign(content.begin(), content.end());
    return true;
  } catch (const std::exception& failure) {
    *error = failure.what();
    return false;
  }
}

bool writeNothing(std::string* /*error*/, const std::string& /*path*/,
                  const std::vector<unsigned char>& /*content*/, void* /*user*/) {
  return false;
}

/// The library's reason, in our words if it is about the file of a buffer.
std::string reasonFor(const std::string& error, const std::string& folder) {
  const std::string line = onOneLine(error.substr(0, error.find('\n')));
  constexpr std::string_view kNotFound = "File not found : ";
  if (line.starts_with(kNotFound)) {
    const std::string name = line.substr(kNotFound.size());
    return fmt::format("its buffer file {}: {}", name,
                       whyNotAFile((std::filesystem::path(folder) / name).string()));
  }
  constexpr std::string_view kMismatch = "File size mismatch : ";
  if (line.starts_with(kMismatch)) {
    return fmt::format("its buffer file {}; export the scene again with it",
                       line.substr(kMismatch.size()));
  }
  return fmt::format("cannot be read as glTF 2.0 ({}); export the scene again",
                     line.empty() ? "no reason given" : line);
}

void parse(const std::string& content, GltfFile& file) {
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(keepEncoded, nullptr);
  parser.SetFsCallbacks({isFile, asItStands, readBytes, writeNothing, nullptr});
  const std::string folder = std::filesystem::path(file.path).parent_path().string();
  const auto size = static_cast<unsigned int>(content.size());
  std::string error;
  std::string warning;
  bool good = false;
  try {
    good = isGlb(content)
               ? parser.LoadBinaryFromMemory(&file.model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(content.data()),
                                             size, folder)
               : parser.LoadASCIIFromString(&file.model, &error, &warning, content.data(), size,
                                            folder);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // Mostly an error of the standard library (an index out of range), whose text does not help.
    file.fail(
        "cannot be read as glTF 2.0 (a size or a number in it is impossible); export the "
        "scene again");
  }
  if (!good) file.fail(reasonFor(error, folder));
}

}  // namespace

bool isSupportedGltfExtension(const std::string& name) {
  constexpr std::array<std::string_view, 8> kSupported = {"KHR_materials_emissive_strength",
                                                          "KHR_texture_transform",
                                                          "KHR_mesh_quantization",
                                                          "KHR_materials_pbrSpecularGlossiness",
                                                          "EXT_texture_webp",
                                                          "EXT_mesh_gpu_instancing",
                                                          kGltfLights,
                                                          kGltfPhotometry};
  return isGltfCompression(name) ||
         std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

bool leavesGeometry(const std::string& name) {
  constexpr std::array<std::string_view, 11> kKinds = {
      "KHR_materials_",    "KHR_texture_",  "KHR_lights_",     "KHR_xmp",
      "KHR_animation_",    "EXT_texture_",  "EXT_lights_",     "EXT_structural_metadata",
      "EXT_mesh_features", "MSFT_texture_", "ADOBE_materials_"};
  return std::any_of(kKinds.begin(), kKinds.end(),
                     [&](std::string_view kind) { return name.starts_with(kind); });
}

std::string readGltf(const std::string& path) {
  std::string content = readWholeFile(path);
  if (content.size() > std::size_t(std::numeric_limits<unsigned int>::max())) {
    throw InputError(path + ": is larger than 4 GiB; split the scene");
  }
  checkGltf(path, content);
  return gltfWithoutCompression(path, std::move(content));
}

GltfFile parseGltfContent(const std::string& path, const std::string& content) {
  GltfFile file;
  file.path = path;
  parse(content, file);
  return file;
}

GltfFile parseGltf(const std::string& path) { return parseGltfContent(path, readGltf(path)); }

const unsigned char* GltfFile::viewBytes(int view_index, std::size_t offset, std::size_t stride,
                                         std::size_t element, std::size_t count,
                                         const std::string& what) const {
  const tinygltf::BufferView& view = at(model.bufferViews, view_index, "buffer view", what);
  const tinygltf::Buffer& buffer = at(model.buffers, view.buffer, "buffer", what);
  const bool view_fits = view.byteOffset <= buffer.data.size() &&
                         view.byteLength <= buffer.data.size() - view.byteOffset;
  // The comparisons cannot overflow for any values in the file.
  const bool fits = view_fits && offset <= view.byteLength && element <= view.byteLength - offset &&
                    (count - 1) <= (view.byteLength - offset - element) / stride;
  if (!fits) fail(what + " reaches beyond the end of its buffer; export the scene again");
  return buffer.data.data() + view.byteOffset + offset;
}

std::span<const unsigned char> GltfFile::imageBytes(const tinygltf::Image& image,
                                                    const std::string& what) const {
  if (image.bufferView < 0) return image.image;
  const std::size_t size = at(model.bufferViews, image.bufferView, "buffer view", what).byteLength;
  if (size == 0) return {};
  return {viewBytes(image.bufferView, 0, size, size, 1, what), size};
}

std::vector<double> GltfFile::readNumbers(int accessor_index, int components,
                                          const std::string& what) const {
  const tinygltf::Accessor& accessor = at(model.accessors, accessor_index, "accessor", what);
  const int type = accessor.componentType;
  if (!isComponentType(type) || accessor.count == 0 ||
      tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)) != components) {
    fail(fmt::format("{} is not a list of {} numbers an element; export the scene again", what,
                     components));
  }
  const auto size = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(type)));
  const auto width = std::size_t(components);
  std::vector<double> values;
  if (accessor.bufferView >= 0) {
    const std::size_t given_stride =
        at(model.bufferViews, accessor.bufferView, "buffer view", what).byteStride;
    const std::size_t stride = given_stride != 0 ? given_stride : size * width;
    const unsigned char* bytes = viewBytes(accessor.bufferView, accessor.byteOffset, stride,
                                           size * width, accessor.count, what);
    values.reserve(accessor.count * width);
    for (std::size_t k = 0; k < accessor.count; ++k) {
      for (std::size_t c = 0; c < width; ++c) {
        values.push_back(loadComponent(bytes + k * stride + c * size, type));
      }
    }
  } else {
    requireData(accessor, what);
    values.assign(accessor.count * width, 0.0);
  }
  if (accessor.sparse.isSparse) applySparse(accessor, components, values, what);
  if (accessor.normalized) {
    for (double& value : values) value = std::max(value / normalisation(type), -1.0);
  }
  return values;
}

std::vector<Vec3> GltfFile::readColours(int accessor, const std::string& what) const {
  const bool has_alpha = at(model.accessors, accessor, "accessor", what).type == TINYGLTF_TYPE_VEC4;
  const std::size_t components = has_alpha ? 4 : 3;
  const std::vector<double> numbers = readNumbers(accessor, int(components), what);
  std::vector<Vec3> colours;
  colours.reserve(numbers.size() / components);
  for (std::size_t k = 0; k < numbers.size(); k += components) {
    colours.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  }
  return colours;
}

/// An accessor without a buffer view is zeros but for its sparse values. Refuses one without sparse
/// values, which has no data, and one with more elements than the buffers have bytes.
void GltfFile::requireData(const tinygltf::Accessor& accessor, const std::string& what) const {
  if (!accessor.sparse.isSparse) {
    fail(what + " has no data (no buffer view); export the scene again, without compression");
  }
  std::size_t bytes = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) bytes += buffer.data.size();
  if (accessor.count <= bytes) return;
  fail(
      fmt::format("{} claims {} elements, more than the {} bytes of all buffers; export the scene "
                  "again",
                  what, accessor.count, bytes));
}

void GltfFile::applySparse(const tinygltf::Accessor& accessor, int components,
                           std::vector<double>& values, const std::string& what) const {
  const auto& sparse = accessor.sparse;
  const int index_type = sparse.indices.componentType;
  if (sparse.count < 1 || !isIndexType(index_type) || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0) {
    fail(what + " has a malformed sparse part; export the scene again");
  }
  const auto count = std::size_t(sparse.count);
  const auto width = std::size_t(components);
  const auto size =
      std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType)));
  const auto index_size = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(index_type)));
  const unsigned char* indices =
      viewBytes(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), index_size,
                index_size, count, what);
  const unsigned char* bytes =
      viewBytes(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), size * width,
                size * width, count, what);
  for (std::size_t k = 0; k < count; ++k) {
    const auto target = std::size_t(loadComponent(indices + k * index_size, index_type));
    if (target >= accessor.count) fail(what + " has a sparse index beyond its end");
    for (std::size_t c = 0; c < width; ++c) {
      values[target * width + c] =
          loadComponent(bytes + (k * width + c) * size, accessor.componentType);
    }
  }
}

std::vector<Index> GltfFile::readIndices(int accessor_index, const std::string& what) const {
  const tinygltf::Accessor& accessor = at(model.accessors, accessor_index, "accessor", what);
  if (!isIndexType(accessor.componentType)) {
    fail(what + " are not unsigned integers; export the scene again");
  }
  const std::vector<double> numbers = readNumbers(accessor_index, 1, what);
  return {numbers.begin(), numbers.end()};
}

}  // namespace radiosity
