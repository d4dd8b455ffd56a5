// Cameras as text, on the command line and in an OBJ's comments.
#pragma once

#include <string>
#include <string_view>

#include "radiosity/scene.h"

namespace radiosity {

/// Reads "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES" with `separator` between the parts: ';', or
/// ' ' for blanks. up and fov may be left out: up is then the scene's, +y or +z, or -z or +y for a
/// view straight up or down. Errors: InputError "camera: which part is wrong". The user of the view
/// checks whether it makes sense (eye and target apart, an angle below 180 degrees).
Camera readCamera(std::string_view text, char separator, Up up = Up::y);

}  // namespace radiosity
