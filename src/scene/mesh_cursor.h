// Reads mesh files from beginning to end: words and numbers in text, or binary numbers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "radiosity/base.h"

namespace radiosity {

/// The encoding of numbers in a file.
enum class Encoding { text, little, big };

enum class NumberType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// The bytes of a number in a binary file.
std::size_t sizeOf(NumberType type);

/// Whether it is a floating-point number.
inline bool isFraction(NumberType type) {
  return type == NumberType::f32 || type == NumberType::f64;
}

/// A place in a mesh file. All errors are InputErrors "FILE:LINE: what; cure", or after the first
/// binary number "FILE: byte N: what; cure".
class MeshCursor {
 public:
  /// `content` must outlive the cursor. Numbers are text until setEncoding().
  MeshCursor(std::string file, std::string_view content) : file_(std::move(file)), all_(content) {}

  [[noreturn]] void fail(const std::string& what) const;

  /// Whether only blanks are left.
  bool atEnd();
  /// The next word between blanks, across line ends. Fails at the end of the file.
  std::string_view word();
  /// The rest of this line, without blanks at its ends; the next read begins after it.
  std::string_view restOfLine();
  /// The next line that is not blank, without blanks at its ends; empty at the end of the file.
  std::string_view nextLine();

  void setEncoding(Encoding encoding) { encoding_ = encoding; }
  Encoding encoding() const { return encoding_; }
  /// The next number; in text, a word that is a number. `what` names it in the error. A number that
  /// is not finite is an error.
  double number(NumberType type, const char* what);
  /// The same for integers, of an integer type.
  long long integer(NumberType type, const char* what);
  /// The number of `what` that follow, each of `numbers` numbers. It must fit into the rest of the
  /// file, so that a forged count reserves no memory.
  std::size_t count(NumberType type, const char* what, NumberType of, std::size_t numbers = 1);
  /// The same if the number is a line of text also in a binary file, and numbers follow it.
  std::size_t textCount(const char* what, NumberType of, std::size_t numbers = 1);
  /// A number of 0 or more that is text also in a binary file.
  std::size_t textNumber(const char* what);
  /// Whether these characters come next.
  bool startsWith(std::string_view text) const { return all_.substr(at_).starts_with(text); }
  /// Three coordinates.
  Vec3 place(NumberType type);
  /// Fails unless the rest of the file can hold `count` items of `numbers` numbers.
  void require(std::size_t count, const char* what, NumberType of, std::size_t numbers = 1) const;
  /// Skips numbers of any value.
  void skip(NumberType type, std::size_t count);
  /// Moves after the next line that begins with `text`. False, without moving, if there is none.
  bool passBehind(std::string_view text);
  /// Raw bytes. Fails if there are fewer.
  std::string_view bytes(std::size_t count);

  /// The line of the word or line read last, counted from 1.
  std::size_t line() const { return line_; }

 private:
  void skipBlanks();
  void passLineEnd();
  template <class Value>
  Value value();
  double binaryNumber(NumberType type);

  std::string file_;
  std::string_view all_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  bool was_binary_ = false;
  Encoding encoding_ = Encoding::text;
};

}  // namespace radiosity
