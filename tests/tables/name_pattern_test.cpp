// Patterns of names, and names near a word.
#include "base/name_pattern.h"

#include <gtest/gtest.h>

#include "base/near_names.h"

namespace radiosity {
namespace {

struct Case {
  const char* pattern;
  const char* name;
  bool matches;
};

TEST(NamePattern, MatchesNamesByWildcardsAndSets) {
  const Case cases[] = {{"*", "", true},
                        {"*wall*", "left_wall/red", true},
                        {"*wall*", "floor", false},
                        {"*a*b*", "xxaxxabxx", true},
                        {"*ab", "aab", true},
                        {"a?c", "abc", true},
                        {"a?c", "ac", false},
                        {"?", "", false},
                        {"[a-c]x", "bx", true},
                        {"[a-c]x", "dx", false},
                        {"[!a-c]x", "dx", true},
                        {"[]]", "]", true},
                        {"a[1]", "a1", true},
                        {"a[1", "a[1", true},
                        {"\\*", "*", true},
                        {"\\*", "a", false},
                        {"name", "name", true},
                        {"name", "names", false}};
  for (const Case& c : cases) {
    EXPECT_EQ(matchesPattern(c.pattern, c.name), c.matches) << c.pattern << " " << c.name;
  }
}

TEST(NamePattern, CharactersAreUtf8) {
  EXPECT_TRUE(matchesPattern("W?nde", "Wände"));
  EXPECT_FALSE(matchesPattern("W??nde", "Wände"));
  EXPECT_TRUE(matchesPattern("???", "日本語"));
  EXPECT_TRUE(matchesPattern("W[äö]nde", "Wände"));
  EXPECT_FALSE(matchesPattern("W[äö]nde", "Wünde"));
  EXPECT_TRUE(matchesPattern("a?c",
                             "a\xff"
                             "c"))
      << "a byte of no character";
}

TEST(NamePattern, NearNamesComeFirst) {
  const std::vector<std::string> names = {"floor", "ceiling/lamp", "back_wall/white", "Lamp2"};
  EXPECT_EQ(nearestFirst("lampp", names),
            (std::vector<std::string>{"ceiling/lamp", "Lamp2", "floor", "back_wall/white"}));
  EXPECT_EQ(nearestFirst("*wal_*", names).front(), "back_wall/white");
  EXPECT_EQ(editDistance("walls", "wlals"), 1u);
}

}  // namespace
}  // namespace radiosity
