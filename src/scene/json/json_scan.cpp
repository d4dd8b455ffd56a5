#include "scene/json_scan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

namespace {

using Json = nlohmann::json;
using Visit = std::function<void(std::span<const JsonStep>, const JsonValue&)>;

/// The deepest nesting. glTF needs about ten levels; libraries use the call stack for each.
constexpr std::size_t kDeepest = 200;

/// Receives the events of nlohmann's parser, which itself does not recurse.
class Events : public nlohmann::json_sax<Json> {
 public:
  Events(const std::string& file, std::string_view text, const Visit& visit)
      : file_(file), text_(text), visit_(visit) {}

  bool null() override { return value({JsonKind::null}); }
  bool boolean(bool b) override { return value({JsonKind::boolean, b ? 1.0 : 0.0}); }
  bool number_integer(number_integer_t n) override { return number(double(n)); }
  bool number_unsigned(number_unsigned_t n) override { return number(double(n)); }
  bool number_float(number_float_t n, const string_t& /*digits*/) override { return number(n); }
  bool string(string_t& s) override { return value({JsonKind::text, 0, s}); }
  bool binary(binary_t& /*bytes*/) override { return false; }  // not in JSON text
  bool start_object(std::size_t /*members*/) override { return begin(JsonKind::object); }
  bool key(string_t& k) override {
    steps_.back().key = k;
    return true;
  }
  bool end_object() override { return end(); }
  bool start_array(std::size_t /*elements*/) override { return begin(JsonKind::array); }
  bool end_array() override { return end(); }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const Json::exception& error) override {
    // 406: a number outside the range of a double.
    fail(position, error.id == 406 ? "a number is too large" : "it is cut off or damaged");
  }

 private:
  [[noreturn]] void fail(std::size_t position, std::string_view what) const {
    const std::size_t at = std::min(position, text_.size());
    const std::size_t from = at < 20 ? 0 : at - 20;
    throw InputError(
        fmt::format("{}: is not JSON that can be read: {} at byte {} (after `{}`); "
                    "export it again",
                    file_, what, position, text_.substr(from, at - from)));
  }
  bool number(double n) { return value({JsonKind::number, n}); }
  bool value(const JsonValue& v) {
    visit_(steps_, v);
    if (!steps_.empty()) ++steps_.back().index;
    return true;
  }
  bool begin(JsonKind kind) {
    visit_(steps_, {kind});
    steps_.emplace_back();
    if (steps_.size() > kDeepest) {
      throw InputError(fmt::format(
          "{}: its JSON is nested more than {} levels deep; export it again", file_, kDeepest));
    }
    return true;
  }
  bool end() {
    steps_.pop_back();
    return value({JsonKind::end});
  }

  const std::string& file_;
  std::string_view text_;
  const Visit& visit_;
  std::vector<JsonStep> steps_;
};

}  // namespace

void scanJson(const std::string& file, std::string_view text, const Visit& visit) {
  Events events(file, text, visit);
  Json::sax_parse(text.begin(), text.end(), &events);
}

}  // namespace radiosity
