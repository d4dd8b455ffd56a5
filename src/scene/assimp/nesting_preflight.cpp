#include "scene/assimp/nesting_preflight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "base/parse.h"
#include "radiosity/base.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Assimp survives some thousands of levels with the usual stack of 8 MB.
constexpr std::size_t kDeepestParts = 1000;

void requireDepth(const std::string& path, std::size_t depth, const char* parts) {
  if (depth <= kDeepestParts) return;
  throw InputError(fmt::format("{}: {} are nested more than {} deep; export it again, or as .glb",
                               path, parts, kDeepestParts));
}

/// The number at a place of a little-endian file.
template <class Number>
std::optional<Number> numberAt(std::string_view content, std::size_t at) {
  if (at > content.size() || content.size() - at < sizeof(Number)) return std::nullopt;
  Number number;
  std::memcpy(&number, content.data() + at, sizeof number);
  return number;
}

/// The places behind each occurrence of `mark`.
template <class Visit>
void forEach(std::string_view content, std::string_view mark, const Visit& visit) {
  for (std::size_t at = content.find(mark); at != std::string_view::npos;
       at = content.find(mark, at + mark.size())) {
    visit(at + mark.size());
  }
}

/// Objects with their numbers, and which of them contain which.
struct FbxModels {
  std::set<std::int64_t> models;
  std::multimap<std::int64_t, std::int64_t> children;  ///< by parent
};

constexpr std::string_view kBinaryFbx = "Kaydara FBX Binary";

/// Binary FBX has properties of a letter and a value: L is a number, S a text with its length.
FbxModels modelsOfBinary(std::string_view content) {
  FbxModels found;
  forEach(content, "\5ModelL", [&](std::size_t at) {
    if (const auto number = numberAt<std::int64_t>(content, at)) found.models.insert(*number);
  });
  constexpr std::string_view kConnection("S\2\0\0\0OOL", 8);
  forEach(content, kConnection, [&](std::size_t at) {
    const auto child = numberAt<std::int64_t>(content, at);
    const auto parent = numberAt<std::int64_t>(content, at + sizeof(std::int64_t) + 1);
    if (child && parent) found.children.emplace(*parent, *child);
  });
  return found;
}

/// The numbers, separated by commas, at the beginning of the text.
std::vector<std::int64_t> numbersIn(std::string_view text, std::size_t count) {
  std::vector<std::int64_t> numbers;
  for (const std::string_view part : splitAt(text.substr(0, text.find('\n')), ',')) {
    const std::optional<long long> number = parseInteger(trimmed(part));
    if (!number || numbers.size() == count) break;
    numbers.push_back(*number);
  }
  return numbers;
}

FbxModels modelsOfText(std::string_view content) {
  FbxModels found;
  forEach(content, "Model:", [&](std::size_t at) {
    for (const std::int64_t number : numbersIn(content.substr(at), 1)) found.models.insert(number);
  });
  forEach(content, "\"OO\",", [&](std::size_t at) {
    const std::vector<std::int64_t> ends = numbersIn(content.substr(at), 2);
    if (ends.size() == 2) found.children.emplace(ends[1], ends[0]);
  });
  return found;
}

/// Takes away models that no other contains, level by level. What is left contains itself.
void checkModels(const std::string& path, const FbxModels& fbx) {
  std::map<std::int64_t, std::size_t> parents;
  for (const std::int64_t model : fbx.models) parents[model] = 0;
  const auto forChildren = [&](std::int64_t model, const auto& visit) {
    const auto [first, last] = fbx.children.equal_range(model);
    for (auto at = first; at != last; ++at) {
      if (fbx.models.contains(at->second)) visit(at->second);
    }
  };
  for (const std::int64_t model : fbx.models) {
    forChildren(model, [&](std::int64_t child) { ++parents[child]; });
  }
  std::vector<std::int64_t> level;
  for (const auto& [model, count] : parents) {
    if (count == 0) level.push_back(model);
  }
  std::size_t left = fbx.models.size();
  for (std::size_t depth = 1; !level.empty(); ++depth) {
    requireDepth(path, depth, "models");
    left -= level.size();
    std::vector<std::int64_t> next;
    for (const std::int64_t model : level) {
      forChildren(model, [&](std::int64_t child) {
        if (--parents[child] == 0) next.push_back(child);
      });
    }
    level = std::move(next);
  }
  if (left > 0) {
    throw InputError(path + ": a model contains itself, by way of others; export it again");
  }
}

void checkBraces(const std::string& path, std::string_view content) {
  std::size_t depth = 0;
  bool quoted = false;
  for (const char c : content) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '{') requireDepth(path, ++depth, "its parts");
    if (c == '}' && depth > 0) --depth;
  }
}

/// A record begins with its end, three sizes and its name; records within it follow its properties.
/// Numbers have 8 bytes from version 7.5 on, before it 4.
template <class Number>
void checkRecords(const std::string& path, std::string_view content) {
  constexpr std::size_t kFirst = 27;
  constexpr std::size_t kHeader = 3 * sizeof(Number) + 1;
  std::vector<std::size_t> ends;
  for (std::size_t at = kFirst; at < content.size();) {
    const auto end = numberAt<Number>(content, at);
    const auto properties = numberAt<Number>(content, at + 2 * sizeof(Number));
    const auto name = numberAt<std::uint8_t>(content, at + 3 * sizeof(Number));
    if (!end || !properties || !name) return;
    if (*end == 0) {
      at += kHeader;  // no record: the end of a list
    } else if (*end <= at || *end > content.size() || *properties > content.size()) {
      return;
    } else if (const std::size_t within = at + kHeader + *name + *properties; within < *end) {
      ends.push_back(*end);
      requireDepth(path, ends.size(), "its parts");
      at = within;
    } else {
      at = *end;
    }
    while (!ends.empty() && at >= ends.back()) ends.pop_back();
  }
}

}  // namespace

void checkFbxNesting(const std::string& path, std::string_view content) {
  if (!content.starts_with(kBinaryFbx)) {
    checkBraces(path, content);
    return checkModels(path, modelsOfText(content));
  }
  constexpr std::size_t kVersion = 23;
  constexpr std::uint32_t kLarge = 7500;
  if (numberAt<std::uint32_t>(content, kVersion).value_or(0) >= kLarge) {
    checkRecords<std::uint64_t>(path, content);
  } else {
    checkRecords<std::uint32_t>(path, content);
  }
  checkModels(path, modelsOfBinary(content));
}

}  // namespace radiosity
