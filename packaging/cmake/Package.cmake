# What is installed, and the packages: `cpack -G DEB` and `cpack -G TGZ` in the build folder.
# Everything lies below the prefix, where programs find it from where they are; the .deb's files
# outside of it are put there by debian_files.cmake.

set(here ${CMAKE_SOURCE_DIR}/packaging)
set(made ${CMAKE_BINARY_DIR}/packaging)

# The package of those who practise and teach; what researchers measure with is one of its own.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME workstation)
install(TARGETS trephine trephine-lab DESTINATION bin)
install(TARGETS trephine-measure DESTINATION bin COMPONENT researcher)
install(TARGETS trephine_openhaptics trephine_pedal trephine_simulated trephine_woodenhaptics
        LIBRARY DESTINATION lib/trephine/plugins)
install(DIRECTORY ${TREPHINE_RESOURCE_DIR}/ DESTINATION share/trephine PATTERN "*.py" EXCLUDE)
install(FILES ${CMAKE_BINARY_DIR}/lib/trephine/cases/cranium.case
              ${CMAKE_BINARY_DIR}/lib/trephine/cases/abdomen.case DESTINATION lib/trephine/cases)
install(FILES ${here}/60-trephine-devices.rules DESTINATION lib/udev/rules.d)

install(FILES ${here}/desktop/trephine.desktop DESTINATION share/applications)
install(FILES ${here}/desktop/trephine.xml DESTINATION share/mime/packages)
install(FILES ${here}/desktop/trephine.svg DESTINATION share/icons/hicolor/scalable/apps)
configure_file(${here}/desktop/org.trephine.Trephine.metainfo.xml
               ${made}/org.trephine.Trephine.metainfo.xml @ONLY)
install(FILES ${made}/org.trephine.Trephine.metainfo.xml DESTINATION share/metainfo)

# Their compression has neither name nor time, so that two builds make the same files.
function(trephine_compressed FILE DESTINATION COMPONENT)
  cmake_path(GET FILE FILENAME name)
  add_custom_command(OUTPUT ${made}/${name}.gz
                     COMMAND gzip --no-name --best --stdout ${FILE} > ${made}/${name}.gz
                     DEPENDS ${FILE} VERBATIM)
  list(APPEND compressed ${made}/${name}.gz)
  set(compressed ${compressed} PARENT_SCOPE)
  install(FILES ${made}/${name}.gz DESTINATION ${DESTINATION} COMPONENT ${COMPONENT})
endfunction()
foreach(page trephine trephine-lab trephine-measure)
  configure_file(${here}/man/${page}.1 ${made}/${page}.1 @ONLY)
endforeach()
trephine_compressed(${made}/trephine.1 share/man/man1 workstation)
trephine_compressed(${made}/trephine-lab.1 share/man/man1 workstation)
trephine_compressed(${made}/trephine-measure.1 share/man/man1 researcher)
trephine_compressed(${CMAKE_SOURCE_DIR}/CHANGELOG.md share/doc/trephine workstation)
add_custom_target(trephine_package_files ALL DEPENDS ${compressed})

file(READ ${CMAKE_SOURCE_DIR}/LICENSE TREPHINE_LICENCE)
string(REGEX REPLACE "^BSD 3-Clause License\n+Copyright[^\n]*\n" "" TREPHINE_LICENCE "${TREPHINE_LICENCE}")
string(STRIP "${TREPHINE_LICENCE}" TREPHINE_LICENCE)
string(REGEX REPLACE "\n\n" "\n.\n" TREPHINE_LICENCE "${TREPHINE_LICENCE}")
string(REPLACE "\n" "\n " TREPHINE_LICENCE " ${TREPHINE_LICENCE}")
configure_file(${here}/debian/copyright.in ${made}/copyright @ONLY)
install(FILES ${made}/copyright DESTINATION share/doc/trephine)
install(FILES ${made}/copyright DESTINATION share/doc/trephine-researcher COMPONENT researcher)

set(CPACK_PACKAGE_NAME trephine)
set(CPACK_PACKAGE_VENDOR "the Trephine authors")
set(CPACK_PACKAGE_CONTACT "the Trephine authors <trephine@localhost.localdomain>")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
    GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${here}/cmake/debian_files.cmake)
set(CPACK_PROJECT_CONFIG_FILE ${here}/cmake/package_options.cmake)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_COMPONENTS_ALL workstation researcher)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_WORKSTATION_PACKAGE_NAME trephine)
set(CPACK_DEBIAN_RESEARCHER_PACKAGE_NAME trephine-researcher)
set(CPACK_DEBIAN_WORKSTATION_DESCRIPTION
"practise cutting cranium or liver on a CT, with both hands
A workstation on which a patient's CT becomes a training case: open a DICOM
folder, read its report, and practise cutting bone or liver while two haptic
arms, or mouse and keys, let both hands feel the tissue. Exercises are
recorded, scored and replayed.
.
For training, not for diagnosis or treatment planning.")
set(CPACK_DEBIAN_RESEARCHER_DESCRIPTION
"measurements of the training workstation Trephine
The program trephine-measure: how stable its force controllers are over arms,
hands and tissues, what a tick of touch and a picture cost and how true they
are, how fast CT is read, what arms and headsets do in trouble. Each figure
has its reference from the same run.
.
For those who develop and study Trephine; to practise with, the package
trephine is enough.")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is opened while it runs, and so is found by no tool.
set(CPACK_DEBIAN_WORKSTATION_PACKAGE_DEPENDS "adduser, qt6-qpa-plugins, fonts-dejavu-core")
set(CPACK_DEBIAN_WORKSTATION_PACKAGE_RECOMMENDS
    "libgl1-mesa-dri, libopenxr-loader1, fonts-droid-fallback, xvfb, xauth")
set(CPACK_DEBIAN_WORKSTATION_PACKAGE_CONTROL_EXTRA ${here}/debian/conffiles ${here}/debian/postinst
    ${here}/debian/postrm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_TREPHINE_DEBIAN ${here}/debian)
set(CPACK_TREPHINE_RELEASED "${TREPHINE_RELEASED} 12:00")
include(CPack)
