# cmake -DSOURCE=src/page/browser -DFOLDER=build/.../page -DNODE=... -DNPM=... -P template.cmake
# Makes FOLDER/template.html: the browser's half of a page, without data. All files are written to
# FOLDER; packages are fetched (npm, the network) only if the lock file has changed since the last
# time.
file(GLOB old LIST_DIRECTORIES true ${FOLDER}/*)
list(FILTER old EXCLUDE REGEX "/(node_modules|installed-lock\\.json|template\\.html)$")
if(old)
  file(REMOVE_RECURSE ${old})
endif()
file(COPY ${SOURCE}/ DESTINATION ${FOLDER} PATTERN node_modules EXCLUDE)

set(lock ${FOLDER}/package-lock.json)
set(installed ${FOLDER}/installed-lock.json)
if(EXISTS ${installed})
  file(SHA256 ${lock} wanted)
  file(SHA256 ${installed} have)
endif()
if(NOT EXISTS ${installed} OR NOT EXISTS ${FOLDER}/node_modules OR NOT wanted STREQUAL have)
  file(REMOVE ${installed})
  message(STATUS "page: npm ci")
  execute_process(COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error
                  WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE failed OUTPUT_QUIET)
  if(failed)
    message(FATAL_ERROR "npm ci failed in ${FOLDER}: it needs the network once; to build without "
                        "pages configure with -DRADIOSITY_PAGE=OFF")
  endif()
  configure_file(${lock} ${installed} COPYONLY)
endif()
execute_process(COMMAND ${NODE} build.mjs template.html WORKING_DIRECTORY ${FOLDER}
                RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "node build.mjs failed in ${FOLDER}")
endif()
