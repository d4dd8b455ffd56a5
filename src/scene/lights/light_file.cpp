#include "radiosity/light_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/input_file.h"
#include "base/printable.h"
#include "scene/json_scan.h"
#include "scene/lights/light_names.h"
#include "scene/lights/light_text.h"

namespace radiosity {

namespace {

/// A light of the list, while it is read.
struct ListedLight {
  std::string kind;
  std::string name;  ///< empty: it has none
  std::string text;  ///< ",NAME=VALUE" of each
};

class LightList {
 public:
  explicit LightList(const std::string& path) : path_(path) {
    scanJson(path, readWholeFile(path),
             [this](std::span<const JsonStep> at, const JsonValue& value) { visit(at, value); });
    if (listed_.empty()) fail("has no lights; write [{\"kind\": \"point\", \"intensity\": 10}]");
  }

  void addTo(std::vector<Light>& lights) {
    std::vector<Light> all;
    for (std::size_t k = 0; k < listed_.size(); ++k) {
      all.push_back(lightAt(k));
      if (listed_[k].name.empty() && all[k].traits().single) listed_[k].name = all[k].name;
    }
    requireNamesOfTheirOwn();
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (listed_[k].name.empty()) {
        all[k].name = nextName(all[k].name, [&](const std::string& name) {
          return isCalled(lights, name) || isListed(name);
        });
      }
      setLight(lights, std::move(all[k]));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path_, what));
  }

  Light lightAt(std::size_t k) const {
    try {
      const std::string& text = listed_[k].text;
      Light light = lightOf(listed_[k].kind, text.substr(text.empty() ? 0 : 1));
      light.validate();
      return light;
    } catch (const InputError& error) {
      fail(fmt::format("light {}: {}", k + 1, error.what()));
    }
  }

  bool isListed(const std::string& name) const {
    return std::ranges::find(listed_, name, &ListedLight::name) != listed_.end();
  }

  void requireNamesOfTheirOwn() const {
    std::map<std::string, std::size_t> first;
    for (std::size_t k = 0; k < listed_.size(); ++k) {
      const std::string& name = listed_[k].name;
      if (name.empty()) continue;
      const auto [same, is_new] = first.emplace(name, k);
      if (is_new) continue;
      fail(fmt::format("lights {} and {} are both called '{}'; give each a name of its own",
                       same->second + 1, k + 1, printable(name)));
    }
  }

  void visit(std::span<const JsonStep> at, const JsonValue& value) {
    const bool ends = value.kind == JsonKind::end;
    if (at.empty()) {
      if (value.kind == JsonKind::array || ends) return;
      fail("is not a list of lights; write [{\"kind\": \"point\", \"intensity\": 10}]");
    }
    if (at.size() == 1) {
      if (value.kind == JsonKind::object) listed_.emplace_back();
      if (value.kind == JsonKind::object || ends) return;
      fail(fmt::format("light {} is no object; write {{\"kind\": \"point\", \"intensity\": 10}}",
                       at[0].index + 1));
    }
    if (at.size() == 2) return takeValue(at[1].key, value);
    if (at.size() == 3 && value.kind == JsonKind::number) {
      listed_.back().text += fmt::format("{}{}", at[2].index == 0 ? "" : ",", value.number);
      return;
    }
    refuse(at[1].key);
  }

  void takeValue(const std::string& name, const JsonValue& value) {
    ListedLight& light = listed_.back();
    if (value.kind == JsonKind::end) return;
    if (value.kind == JsonKind::text && name == "kind") {
      light.kind = value.text;
      return;
    }
    light.text += fmt::format(",{}=", encodedText(name));
    if (value.kind == JsonKind::text && name == "name") light.name = value.text;
    if (value.kind == JsonKind::number) {
      light.text += fmt::format("{}", value.number);
    } else if (value.kind == JsonKind::text) {
      light.text += textOf(name, value.text);
    } else if (value.kind != JsonKind::array) {
      refuse(name);
    }
  }

  std::string textOf(const std::string& name, std::string_view text) const {
    if (name == "name") return encodedText(text);
    if (name == "file") {
      const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
      return encodedText((folder / std::filesystem::path(text)).string());
    }
    if (text.find('=') != text.npos) {
      fail(fmt::format("light {}: {} '{}' has a =; give each parameter a member of its own",
                       listed_.size(), printable(name), printable(text)));
    }
    return std::string(text);
  }

  [[noreturn]] void refuse(const std::string& name) const {
    fail(fmt::format("light {}: {} is no number, list of numbers or text; give one", listed_.size(),
                     printable(name)));
  }

  std::string path_;
  std::vector<ListedLight> listed_;
};

}  // namespace

void addLights(const std::string& path, std::vector<Light>& lights) {
  LightList(path).addTo(lights);
}

}  // namespace radiosity
