// Checks the nesting of an FBX file before Assimp reads it: Assimp follows nesting without a limit,
// on the call stack.
#pragma once

#include <string>
#include <string_view>

namespace radiosity {

/// Errors: InputError "PATH: what is wrong; cure" for parts nested more than 1,000 deep, and for
/// models of FBX that contain themselves. What else is wrong with the file is left to Assimp.
void checkFbxNesting(const std::string& path, std::string_view content);

}  // namespace radiosity
