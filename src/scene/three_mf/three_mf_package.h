// The models in a 3MF file (3MF Consortium, "3MF Core Specification" 1.3): a zip archive of XML
// files. The root file has the build.
#pragma once

#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "scene/three_mf/zip_archive.h"

namespace radiosity {

/// One XML file with objects and materials.
struct ThreeMfModel {
  std::string name;  ///< of the file in the archive
  pugi::xml_document document;
  pugi::xml_node root;                              ///< its element `model`
  std::map<std::string, pugi::xml_node> resources;  ///< objects and groups of materials, by id
};

/// An element's or attribute's name without the prefix of its namespace.
std::string_view localName(std::string_view name);
/// The first child of that name, with any prefix; an empty node if there is none.
pugi::xml_node childNamed(const pugi::xml_node& parent, std::string_view name);

/// All errors are InputError "PATH: what; cure".
class ThreeMfPackage {
 public:
  explicit ThreeMfPackage(const std::string& path);

  /// The model with the build.
  const ThreeMfModel& root() { return model(root_name_); }
  /// The model in a file of the archive; it lives as long as the package.
  const ThreeMfModel& model(const std::string& name);
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string rootName() const;
  void parse(const std::string& name, pugi::xml_document& document) const;
  std::unique_ptr<ThreeMfModel> readModel(const std::string& name) const;

  const std::string& path_;
  std::string content_;
  ZipArchive archive_;
  std::string root_name_;
  std::map<std::string, std::unique_ptr<ThreeMfModel>> models_;  ///< those read so far
};

}  // namespace radiosity
