// Each struct has one list of fields (fields.h), which is used to write, to read and to count
// bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "radiosity/names.h"
#include "results/h5.h"
#include "results/h5_reader.h"

namespace radiosity::h5 {

/// The representation of a type in an attribute: `count` numbers.
template <class T>
struct Scalar {
  using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
  static constexpr std::size_t kCount = 1;
};
template <>
struct Scalar<Vec3> {
  using Stored = double;
  static constexpr std::size_t kCount = 3;
};

/// Puts fields into an OutputGroup or a SizeCounter: numbers and texts as attributes, vectors as
/// datasets.
template <class Sink>
class FieldWriter {
 public:
  static constexpr bool kReading = false;
  explicit FieldWriter(Sink& sink) : sink_(&sink) {}

  template <class T>
  void operator()(const char* name, const T& value) {
    using Stored = typename Scalar<T>::Stored;
    if constexpr (std::is_same_v<T, bool>) {
      const Stored stored = value ? 1 : 0;
      sink_->attribute(name, numberOf<Stored>(), 1, &stored);
    } else {
      sink_->attribute(name, numberOf<Stored>(), Scalar<T>::kCount, &value);
    }
  }
  void operator()(const char* name, const std::string& value) { sink_->text(name, value); }
  template <class T>
  void operator()(const char* name, const std::optional<T>& value) {
    if (value) (*this)(name, *value);
  }
  template <class T>
  void operator()(const char* name, const std::vector<T>& values, const char* unit = "") {
    rows(name, values, Element<T>::kColumns, unit);
  }
  void operator()(const char* name, const std::vector<std::string>& values) {
    sink_->strings(name, values);
  }
  /// A vector in which NaN stands for a missing number.
  void gaps(const char* name, const std::vector<double>& values, const char* unit = "") {
    (*this)(name, values, unit);
  }
  /// A vector of numbers, stored as rows of `columns`.
  template <class T>
  void rows(const char* name, const std::vector<T>& values, std::size_t columns,
            const char* unit = "") {
    using Component = typename Element<T>::Scalar;
    const std::size_t numbers = values.size() * kNumbersIn<T>;
    const Shape shape{numberOf<Component>(), columns == 0 ? numbers : numbers / columns, columns};
    sink_->dataset(name, shape, values.data(), unit);
  }
  /// A few numbers as one attribute; no attribute if there are none.
  void numbers(const char* name, const std::vector<double>& values, std::size_t /*count*/) {
    if (!values.empty()) sink_->attribute(name, Number::f64, values.size(), values.data());
  }
  /// An enum, as its word in `names`.
  template <class Enum, std::size_t N>
  void choice(const char* name, const Enum& value, const NameTable<Enum, N>& names) {
    sink_->text(name, nameOf(names, value));
  }
  /// The same for a field that older files lack: reading them leaves the value unchanged.
  template <class Enum, std::size_t N>
  void laterChoice(const char* name, const Enum& value, const NameTable<Enum, N>& names) {
    choice(name, value, names);
  }
  /// Texts that older files lack; not written if there are none.
  void later(const char* name, const std::vector<std::string>& values) {
    if (!values.empty()) sink_->strings(name, values);
  }
  /// A vector that older files lack; not written if it is empty.
  template <class T>
  void laterRows(const char* name, const std::vector<T>& values) {
    if (!values.empty()) (*this)(name, values);
  }
  /// A text that older files lack and that may be longer than an attribute.
  void laterText(const char* name, const std::string& value) {
    if (!value.empty()) sink_->strings(name, {value});
  }
  /// Whether an optional value has a group; reading makes the value if it has.
  template <class T>
  bool present(const char* /*name*/, const std::optional<T>& value) {
    return value.has_value();
  }
  /// A group that files of earlier versions may lack: what it is of stays as it is then.
  template <class Body>
  void laterGroup(const char* name, const Body& body) {
    group(name, body);
  }
  template <class Body>
  void group(const char* name, const Body& body) {
    auto inner_sink = sink_->group(name);
    FieldWriter inner(inner_sink);
    body(inner);
  }
  /// A vector of structs as a group with one column for each member.
  template <class Record, class Body>
  void table(const char* name, const std::vector<Record>& records, const Body& body) {
    group(name, [&](FieldWriter& inner) {
      Columns<Record> columns{&inner, &records};
      body(columns);
    });
  }

  template <class Record>
  struct Columns {
    FieldWriter* writer;
    const std::vector<Record>* records;
    template <class T>
    void operator()(const char* name, T Record::*member, const char* unit = "") {
      using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
      std::vector<Stored> column;
      column.reserve(records->size());
      for (const Record& record : *records) column.push_back(record.*member);
      if constexpr (std::is_same_v<T, std::string>) {
        (*writer)(name, column);
      } else {
        (*writer)(name, column, unit);
      }
    }
    template <class Enum, std::size_t N>
    void choice(const char* name, Enum Record::*member, const NameTable<Enum, N>& names) {
      std::vector<std::string> column;
      column.reserve(records->size());
      for (const Record& record : *records) column.push_back(nameOf(names, record.*member));
      (*writer)(name, column);
    }
  };

 private:
  Sink* sink_;
};

/// Takes fields out of an InputGroup.
class FieldReader {
 public:
  static constexpr bool kReading = true;
  explicit FieldReader(const InputGroup& source) : source_(&source) {}

  template <class T>
  void operator()(const char* name, T& value) {
    using Stored = typename Scalar<T>::Stored;
    if constexpr (std::is_same_v<T, bool>) {
      Stored stored = 0;
      source_->attribute(name, numberOf<Stored>(), 1, &stored);
      requireSwitches(name, std::span(&stored, 1));
      value = stored != 0;
    } else {
      source_->attribute(name, numberOf<Stored>(), Scalar<T>::kCount, &value);
    }
  }
  void operator()(const char* name, std::string& value) { value = source_->text(name); }
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    value.reset();
    if (source_->hasAttribute(name)) (*this)(name, value.emplace());
  }
  template <class T>
  void operator()(const char* name, std::vector<T>& values, const char* /*unit*/ = "") {
    rows(name, values, Element<T>::kColumns);
  }
  void operator()(const char* name, std::vector<std::string>& values) {
    values = source_->strings(name);
  }
  /// A vector of numbers, all of them finite.
  template <class T>
  void rows(const char* name, std::vector<T>& values, std::size_t columns,
            const char* /*unit*/ = "") {
    readRows(name, values, columns);
    using Component = typename Element<T>::Scalar;
    if constexpr (std::is_floating_point_v<Component>) {
      const auto* numbers = reinterpret_cast<const Component*>(values.data());
      for (std::size_t k = 0; k < values.size() * kNumbersIn<T>; ++k) {
        if (std::isfinite(numbers[k])) continue;
        source_->failAt(name, k / std::max<std::size_t>(columns, 1), double(numbers[k]));
      }
    }
  }
  void gaps(const char* name, std::vector<double>& values, const char* /*unit*/ = "") {
    readRows(name, values, 0);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::isinf(values[k])) source_->failAt(name, k, values[k]);
    }
  }
  bool hasAttribute(const char* name) const { return source_->hasAttribute(name); }
  /// The number of columns of a dataset.
  int columns(const char* name) const { return source_->columns(name); }
  void numbers(const char* name, std::vector<double>& values, std::size_t count) {
    values.assign(source_->hasAttribute(name) ? count : 0, 0.0);
    if (!values.empty()) source_->attribute(name, Number::f64, count, values.data());
  }
  template <class Enum, std::size_t N>
  void choice(const char* name, Enum& value, const NameTable<Enum, N>& names) {
    value = parse(name, source_->text(name), names);
  }
  template <class Enum, std::size_t N>
  void laterChoice(const char* name, Enum& value, const NameTable<Enum, N>& names) {
    if (source_->hasAttribute(name)) choice(name, value, names);
  }
  void later(const char* name, std::vector<std::string>& values) {
    values.clear();
    if (source_->has(name)) values = source_->strings(name);
  }
  template <class T>
  void laterRows(const char* name, std::vector<T>& values) {
    values.clear();
    if (source_->has(name)) (*this)(name, values);
  }
  void laterText(const char* name, std::string& value) {
    std::vector<std::string> values;
    later(name, values);
    value = values.empty() ? std::string() : std::move(values.front());
  }
  template <class T>
  bool present(const char* name, std::optional<T>& value) {
    if (source_->has(name)) value.emplace();
    return value.has_value();
  }
  /// "NAME WHAT; make the file again".
  [[noreturn]] void fail(const char* name, const std::string& what) const {
    source_->fail(name, what);
  }
  template <class Body>
  void laterGroup(const char* name, const Body& body) {
    if (source_->has(name)) group(name, body);
  }
  template <class Body>
  void group(const char* name, const Body& body) {
    const InputGroup inner_source = source_->group(name);
    FieldReader inner(inner_source);
    body(inner);
  }
  template <class Record, class Body>
  void table(const char* name, std::vector<Record>& records, const Body& body) {
    group(name, [&](FieldReader& inner) {
      Columns<Record> columns{&inner, &records};
      body(columns);
    });
  }

  template <class Record>
  struct Columns {
    FieldReader* reader;
    std::vector<Record>* records;
    bool first = true;
    template <class T>
    void operator()(const char* name, T Record::*member, const char* /*unit*/ = "") {
      using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
      std::vector<Stored> column;
      (*reader)(name, column);
      fit(name, column.size());
      if constexpr (std::is_same_v<T, bool>) reader->requireSwitches(name, column);
      for (std::size_t k = 0; k < column.size(); ++k) {
        if constexpr (std::is_same_v<T, bool>) {
          (*records)[k].*member = column[k] != 0;
        } else {
          (*records)[k].*member = std::move(column[k]);
        }
      }
    }
    template <class Enum, std::size_t N>
    void choice(const char* name, Enum Record::*member, const NameTable<Enum, N>& names) {
      std::vector<std::string> column;
      (*reader)(name, column);
      fit(name, column.size());
      for (std::size_t k = 0; k < column.size(); ++k) {
        (*records)[k].*member = reader->parse(name, column[k], names);
      }
    }
    /// Sets the number of records by the first column.
    void fit(const char* name, std::size_t count) {
      if (std::exchange(first, false)) records->resize(count);
      if (records->size() != count) reader->source_->fail(name, "is not as long as its table");
    }
  };

 private:
  template <class T>
  void readRows(const char* name, std::vector<T>& values, std::size_t columns) const {
    using Component = typename Element<T>::Scalar;
    std::size_t count = 0;
    const Handle dataset = source_->open(name, numberOf<Component>(), columns, count);
    const std::size_t numbers = columns == 0 ? count : count * columns;
    values.resize(numbers / kNumbersIn<T>);
    if (!values.empty()) source_->readAll(name, dataset, numberOf<Component>(), values.data());
  }
  void requireSwitches(const char* name, std::span<const std::uint8_t> values) const {
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (values[k] > 1) source_->failAt(name, k, values[k]);
    }
  }
  template <class Enum, std::size_t N>
  Enum parse(const char* name, const std::string& word, const NameTable<Enum, N>& names) const {
    if (const std::optional<Enum> value = named(names, word)) return *value;
    source_->fail(name, "holds the unknown word '" + word + "'");
  }

  const InputGroup* source_;
};

/// The type of a described struct: const unless it is being read.
template <class Archive, class T>
using Described = std::conditional_t<Archive::kReading, T, const T>;

}  // namespace radiosity::h5
