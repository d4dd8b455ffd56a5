// A camera written as text.
#pragma once

#include <string>
#include <string_view>

#include "radiosity/scene.h"

namespace radiosity {

/// Reads "eye=x,y,z target=x,y,z up=x,y,z fov=DEGREES"; parts are separated by blanks or
/// semicolons, up (0,1,0) and fov (the default of Camera) may be left out. Returns what is wrong in
/// a few words, empty where the camera is good.
std::string readCameraText(std::string_view text, Camera& camera);

}  // namespace radiosity
