// A library of this program that is opened when it is first needed.
#pragma once

namespace radiosity {

/// The address of `entry` in the library `name`, which lies beside this one (whose search path is
/// $ORIGIN) and is never closed; its symbols stay private. Null if there is none: dlerror() says
/// why.
void* entryOf(const char* name, const char* entry);

/// The same; RunError "NAME cannot be used (why); install it again ..." if there is none.
void* requiredEntryOf(const char* name, const char* entry);

}  // namespace radiosity
