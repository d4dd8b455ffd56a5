// How messages call an option: each face (C++, Python, the command line) has its own way.
#pragma once

#include <string>
#include <string_view>

namespace [[gnu::visibility("default")]] radiosity {

/// An option in a message. `field`: of its options struct, or the argument of a function; it is
/// Python's keyword, too. In C++ and Python "weld", "weld=1e-12" or "method='rays'"; on the command
/// line "--weld", "--weld 1e-12" or "--method rays". A text that is kept (a note in a results file)
/// keeps the spelling of the face that it was made for.
std::string spelled(std::string_view field, std::string_view value = {});

using Spelling = std::string (*)(std::string_view field, std::string_view value);
/// Replaces the spelling. Call it before all else: threads are not waited for.
void setSpelling(Spelling spelling);

}  // namespace radiosity
