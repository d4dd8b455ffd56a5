// The version of these headers; the library's file and package have the same.
#pragma once

#define RADIOSITY_VERSION_MAJOR 0
#define RADIOSITY_VERSION_MINOR 1
#define RADIOSITY_VERSION_PATCH 0
#define RADIOSITY_VERSION "0.1.0"
