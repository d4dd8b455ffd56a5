// The keywords for options of the command line.
#pragma once

#include <string>

namespace radiosity::python {

/// Replaces the options in a message of the library by keywords.
std::string withKeywords(std::string text);

}  // namespace radiosity::python
