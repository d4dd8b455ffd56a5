// What options of the command line are called here.
#pragma once

#include <string>

namespace radiosity::python {

/// A message of the library with keywords in place of the options that it names.
std::string withKeywords(std::string text);

}  // namespace radiosity::python
