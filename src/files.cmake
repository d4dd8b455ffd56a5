# What the core does without: readers of scene files that take packages, results files, images, tables,
# pages, the program and the Python package.
find_package(TinyGLTF REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(OpenImageIO REQUIRED)
# Debian's target names OpenCV's headers, which its package does not bring; CMake refuses that.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(REMOVE_ITEM oiio_includes /usr/include/opencv4)
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES
                      "${oiio_includes}")
find_package(ZLIB REQUIRED)
find_package(LibLZMA REQUIRED)
find_path(LZ4_INCLUDE_DIR lz4.h REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
find_package(pugixml REQUIRED)
# Debian's CMake package of Assimp asks for those of its own libraries, which need not be there.
find_path(ASSIMP_INCLUDE_DIR assimp/scene.h REQUIRED)
find_library(ASSIMP_LIBRARY assimp REQUIRED)
file(REAL_PATH ${ASSIMP_LIBRARY} assimp_file)
string(REGEX MATCH "libassimp\\.so\\.[0-9]+" assimp_name ${assimp_file})
find_package(CLI11 REQUIRED)

add_library(radiosity_hdf5 INTERFACE)
target_link_libraries(radiosity_hdf5 INTERFACE ${HDF5_C_LIBRARIES})
target_include_directories(radiosity_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})

add_room(scene/json KNOWS scene USES nlohmann_json::nlohmann_json)
add_room(scene/gltf KNOWS scene/json USES TinyGLTF::TinyGLTF)
target_link_libraries(radiosity_scene_gltf PRIVATE meshoptimizer::meshoptimizer)
add_room(scene/three_mf KNOWS scene USES pugixml::pugixml ZLIB::ZLIB)
add_room(scene/vtk KNOWS scene USES pugixml::pugixml ZLIB::ZLIB LibLZMA::LibLZMA ${LZ4_LIBRARY})
target_include_directories(radiosity_scene_vtk SYSTEM PRIVATE ${LZ4_INCLUDE_DIR})
# Of Assimp the library uses the headers alone.
add_room(scene/assimp KNOWS scene USES pugixml::pugixml)
target_include_directories(radiosity_scene_assimp SYSTEM PRIVATE ${ASSIMP_INCLUDE_DIR})
set_source_files_properties(src/scene/assimp/assimp_process.cpp PROPERTIES
                            COMPILE_DEFINITIONS "RADIOSITY_ASSIMP=\"${assimp_name}\"")
add_room(results HEADERS results names vtk KNOWS gather heat illuminance lightmap scene/gltf
         USES radiosity_hdf5 TinyGLTF::TinyGLTF nlohmann_json::nlohmann_json)
add_room(tables HEADERS tables matrix_files KNOWS results USES nlohmann_json::nlohmann_json)
add_room(compare HEADERS compare KNOWS results)
add_room(interchange HEADERS interchange KNOWS lightmap USES ZLIB::ZLIB)
add_room(pipeline HEADERS pipeline KNOWS results elements)
add_room(page HEADERS page KNOWS pipeline tables USES nlohmann_json::nlohmann_json ZLIB::ZLIB)

# The browser's half of a page is bundled by node and stands in the library as it is. Without node and
# npm all else is built, and `radiosity view` says what it lacks.
if(RADIOSITY_PAGE)
  find_program(RADIOSITY_NODE node)
  find_program(RADIOSITY_NPM npm)
endif()
set(browser ${PROJECT_SOURCE_DIR}/src/page/browser)
if(RADIOSITY_PAGE AND RADIOSITY_NODE AND RADIOSITY_NPM)
  set(page_dir ${PROJECT_BINARY_DIR}/page)
  file(GLOB_RECURSE browser_sources CONFIGURE_DEPENDS ${browser}/*)
  list(FILTER browser_sources EXCLUDE REGEX "/node_modules/")
  add_custom_command(OUTPUT ${page_dir}/template.html
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${browser} -DFOLDER=${page_dir} -DNODE=${RADIOSITY_NODE}
            -DNPM=${RADIOSITY_NPM} -P ${PROJECT_SOURCE_DIR}/src/page/template.cmake
    DEPENDS ${browser_sources} ${PROJECT_SOURCE_DIR}/src/page/template.cmake
    COMMENT "Bundling the page of `radiosity view`" VERBATIM)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/page/template.cpp PROPERTIES
    OBJECT_DEPENDS ${page_dir}/template.html
    COMPILE_DEFINITIONS "RADIOSITY_PAGE_TEMPLATE=\"${page_dir}/template.html\"")
else()
  message(STATUS "No pages (radiosity view): they need node and npm; tools/setup installs both")
endif()

# The code that opens images is a library of its own: the libraries behind it take longer to load
# than most commands to run, and are loaded by those that read or write an image
# (base/image_codec.h).
show_room(images KNOWS base USES OpenImageIO::OpenImageIO)
file(GLOB image_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/images/*.cpp)
add_library(radiosity_images MODULE ${image_sources})
target_link_libraries(radiosity_images PRIVATE room_images)
add_dependencies(radiosity radiosity_images)
add_dependencies(radiosity_inside radiosity_images)

# Draco stands apart, since Debian's brings another TinyGLTF (base/draco_codec.h).
show_room(draco KNOWS base USES draco::draco)
add_library(radiosity_draco MODULE src/draco/draco_codec.cpp)
target_link_libraries(radiosity_draco PRIVATE room_draco)
add_dependencies(radiosity radiosity_draco)
add_dependencies(radiosity_inside radiosity_draco)

# Assimp runs in a process of its own (scene/assimp/assimp_process.h). Sanitizers would need more
# memory than it is given.
show_room(assimp KNOWS scene/assimp)
file(GLOB assimp_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/assimp/*.cpp)
add_executable(radiosity_assimp ${assimp_sources})
set_target_properties(radiosity_assimp PROPERTIES OUTPUT_NAME radiosity-assimp)
target_include_directories(radiosity_assimp SYSTEM PRIVATE ${ASSIMP_INCLUDE_DIR})
target_compile_options(radiosity_assimp PRIVATE -fno-sanitize=all)
target_link_options(radiosity_assimp PRIVATE -fno-sanitize=all)
target_link_libraries(radiosity_assimp PRIVATE room_assimp ${ASSIMP_LIBRARY})
add_dependencies(radiosity radiosity_assimp)
add_dependencies(radiosity_inside radiosity_assimp)

show_room(cli KNOWS base USES CLI11::CLI11 fmt::fmt TBB::tbb nlohmann_json::nlohmann_json)
file(GLOB cli_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/cli/*.cpp)
heavy_first(cli_sources ${cli_sources})
add_executable(radiosity_cli ${cli_sources})
set_target_properties(radiosity_cli PROPERTIES OUTPUT_NAME radiosity BUILD_RPATH "$ORIGIN")
target_link_libraries(radiosity_cli PRIVATE radiosity_inside room_cli)
# The program writes its manual pages and completions.
add_custom_command(TARGET radiosity_cli POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/share
  COMMAND radiosity_cli --manuals ${PROJECT_BINARY_DIR}/share VERBATIM)
# No inner loop is in these: optimising them takes a third of their compiling and gains nothing.
foreach(target IN ITEMS radiosity_cli radiosity_scene radiosity_scene_gltf radiosity_scene_json
        radiosity_scene_three_mf radiosity_scene_vtk radiosity_scene_assimp radiosity_results radiosity_compare
        radiosity_pipeline radiosity_page radiosity_interchange)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endforeach()
# But for what lights send, which all rays ask: by themselves, and after the option above.
foreach(light IN ITEMS background lights lamps skies sky_image sun photometric_light
        photometry/photometry)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/scene/lights/${light}.cpp PROPERTIES
    COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_UNITY_BUILD_INCLUSION ON)
endforeach()

# Debian's packages are of Debian's own interpreter, whatever comes first on the PATH.
if(RADIOSITY_PYTHON)
  if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3)
  endif()
  find_package(Python3 COMPONENTS Interpreter Development.Module)
  set(PYBIND11_NOPYTHON ON)
  find_package(pybind11 QUIET)
endif()
if(Python3_Development.Module_FOUND AND pybind11_FOUND)
  add_subdirectory(src/python)
elseif(RADIOSITY_PYTHON)
  message(STATUS "No Python package (import radiosity): it needs Python's headers and pybind11; "
                 "tools/setup installs both")
else()
  message(STATUS "No Python package (import radiosity): RADIOSITY_PYTHON is OFF")
endif()

set_property(GLOBAL APPEND PROPERTY public_headers include/radiosity/radiosity.h)  # all together
add_subdirectory(src/cli)
