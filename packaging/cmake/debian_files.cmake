# The .debs' files that lie outside of the prefix, or are named as Debian names them.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  # cpack dates the files of a .deb alone.
  execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -exec touch --no-dereference
                          --date @$ENV{SOURCE_DATE_EPOCH} {} + COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()
set(root ${CPACK_TEMPORARY_DIRECTORY}/workstation)
file(MAKE_DIRECTORY ${root}/etc/trephine ${root}/etc/security/limits.d)
configure_file(${CPACK_TREPHINE_DEBIAN}/limits.conf ${root}/etc/security/limits.d/60-trephine.conf
               COPYONLY)
execute_process(COMMAND date --utc --rfc-email --date ${CPACK_TREPHINE_RELEASED}
                OUTPUT_VARIABLE TREPHINE_RELEASED_RFC OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
foreach(component workstation researcher)
  string(TOUPPER ${component} upper)
  set(TREPHINE_PACKAGE ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component})
  configure_file(${CPACK_TREPHINE_DEBIAN}/lintian-overrides.in
                 ${root}/usr/share/lintian/overrides/${TREPHINE_PACKAGE} @ONLY)
  set(changelog ${root}/usr/share/doc/${TREPHINE_PACKAGE}/changelog)
  configure_file(${CPACK_TREPHINE_DEBIAN}/changelog.in ${changelog} @ONLY)
  execute_process(COMMAND gzip --no-name --best ${changelog} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
