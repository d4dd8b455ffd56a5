// How the command line, C++ and Python spell an option in a message of the library.
#include "radiosity/spelling.h"

#include <gtest/gtest.h>

#include "cli/words.h"

namespace radiosity::cli {
namespace {

TEST(Spelling, IsThatOfACallByDefault) {
  EXPECT_EQ(spelled("memory_limit"), "memory_limit");
  EXPECT_EQ(spelled("weld", "1e-12"), "weld=1e-12");
  EXPECT_EQ(spelled("method", "rays"), "method='rays'");
  EXPECT_EQ(spelled("set", "'the lamp.radiance=10'"), "set='the lamp.radiance=10'");
}

TEST(Spelling, OfTheCommandLineHasItsNames) {
  EXPECT_EQ(spelledAsOption("memory_limit", ""), "--memory-limit");
  EXPECT_EQ(spelledAsOption("weld", "1e-12"), "--weld 1e-12");
  EXPECT_EQ(spelledAsOption("near_exact", "exact"), "--near exact");
  EXPECT_EQ(spelledAsOption("exact_emitters", "estimated"), "--emitters estimated");
  EXPECT_EQ(spelledAsOption("groups", "NEW=OLD"), "--group NEW=OLD");
}

TEST(Spelling, IsThatOfTheFaceThatSetIt) {
  setSpelling(spelledAsOption);
  EXPECT_EQ(spelled("method", "rays"), "--method rays");
}

}  // namespace
}  // namespace radiosity::cli
