# trephine_plugin(NAME SOURCES <files> LIBRARIES <targets>): trephine_<NAME>.so, in the tree or alone.
set(TREPHINE_DEVICE_ABI_DIR ${CMAKE_CURRENT_LIST_DIR}/../../modules/device
    CACHE PATH "Folder of trephine_device.h")
if(NOT DEFINED TREPHINE_PLUGIN_DIR)
  set(TREPHINE_PLUGIN_DIR ${CMAKE_BINARY_DIR})
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)

function(trephine_plugin NAME)
  cmake_parse_arguments(PLUGIN "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(target trephine_${NAME})
  add_library(${target} MODULE ${PLUGIN_SOURCES})
  target_include_directories(${target} PRIVATE ${TREPHINE_DEVICE_ABI_DIR})
  target_link_libraries(${target} PRIVATE nlohmann_json::nlohmann_json Threads::Threads
                                          ${PLUGIN_LIBRARIES})
  # Recordings replay bit for bit, so a simulated arm must move in the same bits on every build.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -ffp-contract=off)
  set_target_properties(${target} PROPERTIES
    PREFIX "" SUFFIX ".so"
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${TREPHINE_PLUGIN_DIR})
endfunction()
