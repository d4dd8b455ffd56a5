// Scene files written for one test and gone after it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "radiosity/scene.h"

namespace radiosity::test {

/// A folder of its own for every test.
class SceneFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("radiosity-" + std::to_string(getpid()) + "-" + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// The message of the InputError that `action` throws; a failure where it throws none.
template <class Action>
std::string inputErrorOf(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << "not one line: " << message;
    return message;
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

inline Vec3 corner(const Scene& scene, std::size_t face, std::size_t k) {
  return scene.vertices[scene.face(face)[k]];
}

/// The first note whose text contains `part`; null where there is none.
inline const Note* findNote(const std::vector<Note>& notes, const std::string& part) {
  const auto note = std::find_if(notes.begin(), notes.end(), [&](const Note& n) {
    return n.text.find(part) != std::string::npos;
  });
  return note == notes.end() ? nullptr : &*note;
}

inline std::string allNotes(const std::vector<Note>& notes) {
  std::string text;
  for (const Note& note : notes) text += note.text + "\n";
  return text;
}

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << "in: " << (text)

/// A note that says `part` is there, with this severity.
inline void expectNote(const std::vector<Note>& notes, const std::string& part, Severity severity) {
  const Note* note = findNote(notes, part);
  ASSERT_NE(note, nullptr) << "no note says: " << part << "\n" << allNotes(notes);
  EXPECT_EQ(int(note->severity), int(severity)) << note->text;
}

#define EXPECT_NOTE(notes, part, severity)              \
  do {                                                  \
    SCOPED_TRACE("");                                   \
    radiosity::test::expectNote(notes, part, severity); \
  } while (false)

}  // namespace radiosity::test
