// Libraries and helpers of this program that are opened when they are first needed.
#pragma once

#include <string>

namespace radiosity {

/// The address of `entry` in the library `name`, which lies beside this one (whose search path is
/// $ORIGIN) and is never closed; its symbols stay private. Null if there is none: dlerror() says
/// why.
void* entryOf(const char* name, const char* entry);

/// The same; RunError "NAME cannot be used (why); install it again ..." if there is none.
void* requiredEntryOf(const char* name, const char* entry);

/// The path of a file, no library, that lies where side libraries do. Errors: RunError as above.
std::string requiredFileOf(const char* name);

}  // namespace radiosity
