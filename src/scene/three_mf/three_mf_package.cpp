#include "scene/three_mf/three_mf_package.h"

#include <fmt/format.h>

#include "base/input_file.h"
#include "radiosity/base.h"

namespace radiosity {

std::string_view localName(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node childNamed(const pugi::xml_node& parent, std::string_view name) {
  for (const pugi::xml_node child : parent.children()) {
    if (localName(child.name()) == name) return child;
  }
  return {};
}

ThreeMfPackage::ThreeMfPackage(const std::string& path)
    : path_(path), content_(readWholeFile(path)), archive_(path, content_) {
  root_name_ = rootName();
}

void ThreeMfPackage::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", path_, what));
}

void ThreeMfPackage::parse(const std::string& name, pugi::xml_document& document) const {
  if (!archive_.has(name)) {
    fail(fmt::format("is no 3MF file: its archive has no {}; export it again", name));
  }
  std::string text = archive_.read(name);
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result) {
    fail(fmt::format("{}: is no sound XML (byte {}: {}); export it again", name, result.offset,
                     result.description()));
  }
}

/// The name of the model's file, which another file of the package gives.
std::string ThreeMfPackage::rootName() const {
  pugi::xml_document document;
  parse("_rels/.rels", document);
  for (const pugi::xml_node relation : document.document_element().children()) {
    const std::string_view type = relation.attribute("Type").value();
    if (type.ends_with("/3dmodel")) return relation.attribute("Target").value();
  }
  fail("is no 3MF file: _rels/.rels names no 3dmodel; export it again");
}

const ThreeMfModel& ThreeMfPackage::model(const std::string& name) {
  std::unique_ptr<ThreeMfModel>& place = models_[name];
  if (place == nullptr) place = readModel(name);
  return *place;
}

std::unique_ptr<ThreeMfModel> ThreeMfPackage::readModel(const std::string& name) const {
  auto model = std::make_unique<ThreeMfModel>();
  model->name = name;
  parse(name, model->document);
  model->root = model->document.document_element();
  if (localName(model->root.name()) != "model") {
    fail(fmt::format("{}: has no element `model`; export it again", name));
  }
  for (const pugi::xml_node resource : childNamed(model->root, "resources").children()) {
    const std::string id = resource.attribute("id").value();
    if (!model->resources.try_emplace(id, resource).second) {
      fail(fmt::format("{}: two resources have the id `{}`; export it again", name, id));
    }
  }
  return model;
}

}  // namespace radiosity
