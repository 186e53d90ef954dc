# trephine_room(NAME <room> [DIR <dir>] DEPENDS <rooms> USES <libraries> SOURCES <files>)
#
# The only way to declare a room. DEPENDS are the rooms whose headers it may include, USES the
# libraries; both are written to rooms.json, against which the ctest `architecture` scans every
# #include. A room that depends on one not yet declared is refused, so the arrows cannot turn.

set(TREPHINE_LIBRARY_glm glm::glm)
set(TREPHINE_LIBRARY_json nlohmann_json::nlohmann_json)
set(TREPHINE_LIBRARY_spdlog spdlog::spdlog)
set(TREPHINE_LIBRARY_openssl OpenSSL::Crypto)
set(TREPHINE_LIBRARY_dcmtk DCMTK::DCMTK)
set(TREPHINE_LIBRARY_archive archive)
set(TREPHINE_LIBRARY_openjpeg openjp2)
set(TREPHINE_LIBRARY_hdf5 HDF5::HDF5)
set(TREPHINE_LIBRARY_vtk-image VTK::CommonCore VTK::CommonDataModel VTK::IOImage)
set(TREPHINE_LIBRARY_vtk-rendering VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel
    VTK::CommonTransforms VTK::FiltersCore VTK::FiltersSources VTK::IOGeometry VTK::InteractionStyle
    VTK::RenderingCore VTK::RenderingOpenGL2 VTK::RenderingVolume VTK::RenderingVolumeOpenGL2
    VTK::vtksys)
set(TREPHINE_LIBRARY_vtk-filters VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel
    VTK::FiltersCore VTK::IOGeometry VTK::ImagingGeneral VTK::ImagingMorphological)
set(TREPHINE_LIBRARY_opengl OpenGL::GL GLEW::GLEW)
set(TREPHINE_LIBRARY_qt-gui Qt6::Gui)
set(TREPHINE_LIBRARY_qt-opengl Qt6::Gui Qt6::OpenGL)
# Headers alone: the loader is opened at run time. It is told of the window's graphics in GLX's words.
set(TREPHINE_LIBRARY_openxr OpenXR::headers OpenGL::GLX X11::X11)
set(TREPHINE_LIBRARY_qt Qt6::Widgets Qt6::OpenGLWidgets)
set(TREPHINE_LIBRARY_cli11 CLI11::CLI11)
set(TREPHINE_LIBRARY_zlib ZLIB::ZLIB)
set(TREPHINE_LIBRARY_threads Threads::Threads)
set(TREPHINE_LIBRARY_dl ${CMAKE_DL_LIBS})

function(trephine_room)
  cmake_parse_arguments(ROOM "" "NAME;DIR" "DEPENDS;USES;SOURCES" ${ARGN})
  if(NOT ROOM_DIR)
    set(ROOM_DIR modules/${ROOM_NAME})
  endif()
  set(target trephine_${ROOM_NAME})
  list(TRANSFORM ROOM_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/${ROOM_DIR}/)
  add_library(${target} STATIC ${ROOM_SOURCES})
  target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR}/modules ${CMAKE_SOURCE_DIR})
  foreach(room IN LISTS ROOM_DEPENDS)
    if(NOT TARGET trephine_${room})
      message(FATAL_ERROR "Room '${ROOM_NAME}' depends on '${room}', which is not declared before it.")
    endif()
    target_link_libraries(${target} PUBLIC trephine_${room})
  endforeach()
  foreach(library IN LISTS ROOM_USES)
    if(NOT DEFINED TREPHINE_LIBRARY_${library})
      message(FATAL_ERROR "Room '${ROOM_NAME}' uses '${library}', which TrephineRoom.cmake does not list.")
    endif()
    target_link_libraries(${target} PUBLIC ${TREPHINE_LIBRARY_${library}})
  endforeach()
  list(JOIN ROOM_DEPENDS "\", \"" depends)
  list(JOIN ROOM_USES "\", \"" uses)
  set_property(GLOBAL APPEND PROPERTY TREPHINE_ROOMS
    "{\"name\": \"${ROOM_NAME}\", \"dir\": \"${ROOM_DIR}\", \"depends\": [\"${depends}\"], \"uses\": [\"${uses}\"]}")
endfunction()

function(trephine_write_rooms)
  get_property(rooms GLOBAL PROPERTY TREPHINE_ROOMS)
  list(JOIN rooms ",\n  " text)
  file(WRITE ${CMAKE_BINARY_DIR}/rooms.json "[\n  ${text}\n]\n")
endfunction()
